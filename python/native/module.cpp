// SPDX-License-Identifier: MIT
// The Python module clpv._native: a thin layer over include/clpv. python/clpv/__init__.py has its documentation.
#include "module.hpp"

#include "clpv/device.hpp"
#include "clpv/error.hpp"
#include "clpv/options.hpp"
#include "clpv/version.hpp"
#include "support/log.hpp"

namespace clpv::python {

namespace {

PyObject* new_error(py::module_& module, const char* name, const char* doc, const py::tuple& bases) {
  const std::string full = std::string("clpv.") + name;
  PyObject* made = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr);
  if (made == nullptr) throw py::error_already_set();
  module.add_object(name, made);
  return made;
}

struct Errors {
  PyObject *base, *usage, *bad_input, *device, *run_time, *validation;
  PyObject* of(ExitCode code) const {
    switch (code) {
      case ExitCode::usage:
        return usage;
      case ExitCode::bad_input:
        return bad_input;
      case ExitCode::device:
        return device;
      case ExitCode::run_time:
        return run_time;
      case ExitCode::validation:
        return validation;
      case ExitCode::ok:
        break;
    }
    return base;
  }
};

Errors errors;  // filled once, by add_errors

}  // namespace

void add_errors(py::module_& module) {
  const auto builtin = [](PyObject* type) { return py::reinterpret_borrow<py::object>(type); };
  errors.base =
      new_error(module, "Error", "Any failure of clpv; str() names place, value found and value allowed.",
                py::make_tuple(builtin(PyExc_Exception)));
  const py::object base = builtin(errors.base);
  const auto add = [&](const char* name, const char* doc, PyObject* also) {
    return new_error(module, name, doc, py::make_tuple(base, builtin(also)));
  };
  errors.usage = add("UsageError", "Unknown option or value out of range.", PyExc_ValueError);
  errors.bad_input = add("InputError", "Invalid scene, image, or other input.", PyExc_ValueError);
  errors.device =
      add("DeviceError", "No OpenCL device, or one without a required capability.", PyExc_RuntimeError);
  errors.run_time =
      add("ResourceError", "Out of memory, or a file that cannot be written.", PyExc_RuntimeError);
  errors.validation = add("ValidationError", "A result differs from its reference.", PyExc_RuntimeError);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Interrupted& interrupted) {
      PyErr_SetString(PyExc_KeyboardInterrupt, interrupted.what());
    } catch (const Error& error) {
      PyErr_SetString(errors.of(error.code()), error.what());
    }
  });
}

namespace {

py::list all_options() {
  py::list all;
  for (const OptionDescription& option : Options::all()) {
    all.append(py::dict(py::arg("name") = option.name, py::arg("help") = option.help,
                        py::arg("allowed") = option.allowed, py::arg("value") = option.value));
  }
  return all;
}

py::list devices() {
  py::list all;
  for (const DeviceDescription& device : all_devices()) {
    all.append(py::dict(py::arg("index") = device.index, py::arg("name") = device.name,
                        py::arg("platform") = device.platform, py::arg("driver") = device.driver,
                        py::arg("type") = device.type, py::arg("missing") = device.missing));
  }
  return all;
}

}  // namespace
}  // namespace clpv::python

PYBIND11_MODULE(_native, module) {
  using namespace clpv::python;
  clpv::set_log_level(false, 0);  // to stderr
  module.doc() = "Native part of clpv.";
  module.attr("__version__") = clpv::version();
  add_errors(module);
  add_scene(module);
  add_image(module);
  add_renderer(module);
  add_basis(module);
  module.def("options", &all_options,
             "options() -> list of dict: name, help, allowed values and default of each option of Renderer.");
  module.def(
      "devices", &devices,
      "devices() -> list of dict: all OpenCL devices; clpv can use those whose list `missing` is empty.");
}
