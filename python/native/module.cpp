// SPDX-License-Identifier: MIT
// The Python module clpv._native: a thin layer over include/clpv. python/clpv/__init__.py has its
// documentation.

#include "module.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <mutex>
#include <thread>

#include "clpv/device.hpp"
#include "clpv/log.hpp"
#include "clpv/options.hpp"
#include "clpv/version.hpp"

namespace clpv::python {

namespace {

PyObject* new_error(py::module_& module, const char* name, const char* doc,
                    const py::tuple& bases) {
  const std::string full = std::string("clpv.") + name;
  PyObject* made = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), nullptr);
  if (made == nullptr) throw py::error_already_set();
  module.add_object(name, made);
  return made;
}

std::array<PyObject*, 6> errors;  // by exit code; filled once, by add_errors

// State of this process, guarded by the GIL.
int running = 0;                   // CallsInProgress of process `counted`
pid_t counted = ::getpid();        // a fork copies the count, and not the threads
std::atomic<bool> exiting{false};  // Python's exit has begun
std::thread::id exiting_thread;
pid_t device_user = 0;  // process that called note_device_use() first; a fork copies it
constexpr std::chrono::milliseconds kPoll{5};

using Message = std::pair<LogLevel, std::string>;

/// Messages that log_messages() has not handed over yet.
struct Waiting {
  std::mutex mutex;
  std::vector<Message> messages;
};
Waiting& waiting() {
  static Waiting& one = *new Waiting;  // never destroyed: threads may log while the process ends
  return one;
}

/// A message with the names that Python has for members of the C++ interface.
std::string in_python(std::string message) {
  constexpr std::pair<std::string_view, std::string_view> kNames[] = {
      {"vertical_fov_degrees", "fov"},
      {"inner_cone_degrees", "inner_cone"},
      {"outer_cone_degrees", "outer_cone"}};
  for (const auto& [there, here] : kNames)
    for (std::size_t at = 0; (at = message.find(there, at)) != std::string::npos;)
      message.replace(at, there.size(), here);
  return message;
}

void receive_messages() {
  const py::module_ logging = py::module_::import("logging");
  // Without it, Python prints warnings that nobody handles.
  logging.attr("getLogger")("clpv").attr("addHandler")(logging.attr("NullHandler")());
  set_log(
      [](LogLevel level, const std::string& text) {
        const std::lock_guard lock(waiting().mutex);
        waiting().messages.emplace_back(level, text);
      },
      LogLevel::debug);
}

/// Ends running calls at their next step, and waits for them.
void end_running_calls() {
  exiting = true;
  exiting_thread = std::this_thread::get_id();
  while (counted == ::getpid() && running > 0) {
    py::gil_scoped_release released;
    std::this_thread::sleep_for(kPoll);
  }
}

}  // namespace

CallInProgress::CallInProgress() {
  if (exiting && std::this_thread::get_id() != exiting_thread) {
    PyErr_SetNone(PyExc_SystemExit);  // ends the thread without a message
    throw py::error_already_set();
  }
  if (counted != ::getpid()) running = 0, counted = ::getpid();
  ++running;
}

CallInProgress::~CallInProgress() {
  --running;
}

RunningCall::RunningCall() {
  if (exiting) throw Error(ExitCode::run_time, "clpv: Python is exiting");
  if (forked_from_device_use()) {
    throw Error(ExitCode::run_time,
                "clpv: this process was forked from one that used clpv; allowed: multiprocessing's "
                "start method 'spawn' or 'forkserver'");
  }
}

RunningCall::~RunningCall() {
  try {
    if (!exiting) log_messages();
  } catch (py::error_already_set& error) {
    error.discard_as_unraisable("clpv: logging");
  }
}

void log_messages() {
  std::vector<Message> messages;
  {
    const std::lock_guard lock(waiting().mutex);
    messages.swap(waiting().messages);
  }
  if (messages.empty()) return;
  constexpr int kPythonLevels[] = {10, 20, 30, 40};
  const py::object log = py::module_::import("logging").attr("getLogger")("clpv").attr("log");
  for (const auto& [level, text] : messages)
    log(kPythonLevels[static_cast<int>(level)], "%s", text);
}

bool exit_stops_calls() {
  return exiting;
}

void note_device_use() {
  if (device_user == 0) device_user = ::getpid();
}

bool forked_from_device_use() {
  return device_user != 0 && device_user != ::getpid();
}

void add_errors(py::module_& module) {
  const auto builtin = [](PyObject* type) { return py::reinterpret_borrow<py::object>(type); };
  const auto add = [&](ExitCode code, const char* name, const char* doc, const auto&... bases) {
    errors[static_cast<std::size_t>(code)] =
        new_error(module, name, doc, py::make_tuple(builtin(bases)...));
  };
  add(ExitCode::ok, "Error",
      "Any failure of clpv; str() names place, value found and value allowed.", PyExc_Exception);
  PyObject* const base = errors[0];
  add(ExitCode::usage, "UsageError",
      "Unknown option, value out of range, or argument of another kind; a ValueError and a "
      "TypeError.",
      base, PyExc_ValueError, PyExc_TypeError);
  add(ExitCode::bad_input, "InputError", "Invalid scene, image, or other input.", base,
      PyExc_ValueError);
  add(ExitCode::device, "DeviceError", "No OpenCL device, or one without a required capability.",
      base, PyExc_RuntimeError);
  add(ExitCode::run_time, "ResourceError", "Out of memory, or a file that cannot be written.", base,
      PyExc_RuntimeError);
  add(ExitCode::validation, "ValidationError", "A result differs from its reference.", base,
      PyExc_RuntimeError);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Interrupted& interrupted) {
      PyErr_SetString(exiting ? PyExc_SystemExit : PyExc_KeyboardInterrupt, interrupted.what());
    } catch (const Error& error) {
      const bool of_file = error.code() == ExitCode::bad_input;  // whose names stay
      PyErr_SetString(errors[static_cast<std::size_t>(error.code())],
                      (of_file ? std::string(error.what()) : in_python(error.what())).c_str());
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
  const RunningCall call;
  note_device_use();
  for (const DeviceDescription& device : all_devices()) {
    all.append(py::dict(py::arg("index") = device.index, py::arg("name") = device.name,
                        py::arg("platform") = device.platform, py::arg("driver") = device.driver,
                        py::arg("type") = device.type, py::arg("missing") = device.missing));
  }
  return all;
}

/// Rejects copies and pickles, whose protocols 0 and 1 make objects without a value, and
/// X.__new__(X), which makes another. X() calls pybind11's function through its slot, which stays.
void reject_empty_objects(const py::module_& module) {
  for (const auto& [key, type] : py::dict(module.attr("__dict__"))) {
    if (!PyType_Check(type.ptr()) || PyExceptionClass_Check(type.ptr())) continue;
    const auto name = key.cast<std::string>();
    type.attr("__reduce_ex__") = py::cpp_function(
        [name](const py::object&, int) { throw py::type_error("cannot pickle clpv." + name); },
        py::is_method(type));
    const py::staticmethod made(
        py::cpp_function([name, own = type, base = py::object(type.attr("__new__"))](
                             const py::object& cls, const py::args&, const py::kwargs&) {
          if (cls.is(own)) throw py::type_error("clpv." + name + ": found no call of __init__");
          return base(cls);
        }));
    const auto* object = reinterpret_cast<PyTypeObject*>(type.ptr());
    if (PyDict_SetItemString(object->tp_dict, "__new__", made.ptr()) != 0)
      throw py::error_already_set();
  }
}

}  // namespace
}  // namespace clpv::python

PYBIND11_MODULE(_native, module) {
  using namespace clpv::python;
  // pybind11 looks NumPy up in a static variable that it sets while the GIL may change hands: two
  // threads whose first arrays meet there wait for each other without end. Here is one thread.
  py::dtype::of<float>();
  module.doc() = "Native part of clpv.";
  module.attr("__version__") = clpv::version();
  add_errors(module);
  receive_messages();
  add_scene(module);
  add_image(module);
  add_renderer(module);
  add_basis(module);
  reject_empty_objects(module);
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_running_calls));
  module.def("options", &all_options,
             "Name, help, allowed values and default of each option of Renderer.");
  module.def("devices", &devices,
             "All OpenCL devices; clpv can use those whose list `missing` is empty.");
}
