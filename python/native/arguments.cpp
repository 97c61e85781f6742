// SPDX-License-Identifier: MIT
#include "arguments.hpp"

#include <fmt/ranges.h>

#include <algorithm>

namespace clpv::python {

std::string found(py::handle given) {
  constexpr std::size_t kLongest = 60;
  std::string text;
  try {
    text = py::repr(given).cast<std::string>();
  } catch (const py::error_already_set&) {  // by the object's __repr__
  } catch (const py::cast_error&) {         // lone surrogates
  }
  if (!text.empty() && text.size() <= kLongest && text.find('\n') == std::string::npos) return text;
  return "an object of " + std::string(py::str(py::type::of(given)));
}

bool is_masked(py::handle given) {
  return py::isinstance<py::array>(given) &&
         py::isinstance(given, py::module_::import("numpy.ma").attr("MaskedArray"));
}

bool is_real(py::handle given) {
  if (PyComplex_Check(given.ptr()) || is_masked(given)) return false;
  const py::object type = py::getattr(given, "dtype", py::none());
  if (py::isinstance<py::dtype>(type) && type.cast<py::dtype>().kind() == 'c') return false;
  PyFloat_AsDouble(given.ptr());
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  return true;
}

py::object plain(const py::object& given, int levels) {
  if (levels == 0 || !PySequence_Check(given.ptr())) return given;
  if (py::hasattr(given, "tolist")) return given.attr("tolist")();
  if (!py::isinstance<py::list>(given) && !py::isinstance<py::tuple>(given)) return given;
  py::list all;
  for (const py::object item : py::reinterpret_borrow<py::sequence>(given))
    all.append(plain(item, levels - 1));
  return all;
}

void check_call(const std::string& function, const std::vector<Parameter>& parameters, bool open,
                py::list& args, py::dict& kwargs) {
  const auto positional =
      static_cast<std::size_t>(std::ranges::count(parameters, false, &Parameter::keyword));
  if (args.size() > positional) {
    const std::size_t self =
        !parameters.empty() && parameters[0].name == std::string_view("self") ? 1 : 0;
    throw Error(ExitCode::usage, "{}: found {} arguments by position, allowed: at most {}",
                function, args.size() - self, positional - self);
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Parameter& parameter = parameters[i];
    const bool placed = i < args.size(), by_name = kwargs.contains(parameter.name);
    if (placed && by_name)
      throw Error(ExitCode::usage, "{}: {}: found two values, allowed: one", function,
                  parameter.name);
    if (parameter.takes == nullptr) continue;
    if (i > 0 || parameter.name != std::string_view("self")) names.emplace_back(parameter.name);
    if (!placed && !by_name && parameter.required)
      throw Error(ExitCode::usage, "{}: {}: found none, allowed: {}", function, parameter.name,
                  parameter.allowed());
    if (!placed && !by_name) continue;
    const py::object given = placed ? py::object(args[i]) : py::object(kwargs[parameter.name]);
    const py::object values = parameter.any ? given : plain(given);
    if (placed)
      args[i] = values;
    else
      kwargs[parameter.name] = values;
    if (!parameter.takes(values))
      throw Error(ExitCode::usage, "{}: {}: found {}, allowed: {}", function, parameter.name,
                  found(given), parameter.allowed());
  }
  for (const auto& [key, value] : kwargs) {
    if (!takes<std::string>(key))  // lone surrogates
      throw Error(ExitCode::usage, "{}: found argument {}, allowed: a name in UTF-8", function,
                  found(key));
    if (!open && std::ranges::count(names, key.cast<std::string>()) == 0)
      throw Error(ExitCode::usage, "{}: found argument '{}', allowed: {}", function,
                  key.cast<std::string>(), fmt::join(names, ", "));
  }
}

void check_arguments(const py::object& scope, const char* name, Self self,
                     const std::pair<std::vector<Parameter>, bool>& parameters) {
  const py::object function = scope.attr(name);
  const std::string label =
      self == Self::untyped ? scope.attr("__name__").cast<std::string>() : name;
  const std::string doc = py::str(function.attr("__doc__"));
  const auto call = [=](const py::args& given, const py::kwargs& named) {
    const CallInProgress in_progress;
    py::list args(given);
    py::dict kwargs(**named);
    check_call(label, parameters.first, parameters.second, args, kwargs);
    try {
      return py::object(function(*args, **kwargs));
    } catch (const py::error_already_set& error) {
      const std::string message = usage_message(error);
      if (message.empty() || message.starts_with(label + ":")) throw;
      std::string spoken = label + ": ";  // as C++ may begin: "lookup source: "
      std::ranges::replace(spoken, '_', ' ');
      const std::size_t begin = message.starts_with(spoken) ? spoken.size() : 0;
      throw Error(ExitCode::usage, "{}: {}", label, message.substr(begin));
    }
  };
  py::options options;
  options.disable_function_signatures();  // `doc` has it
  if (self != Self::none)
    scope.attr(name) =
        py::cpp_function(call, py::name(name), py::is_method(scope), py::doc(doc.c_str()));
  else if (PyModule_Check(scope.ptr()))
    scope.attr(name) =
        py::cpp_function(call, py::name(name), py::scope(scope), py::doc(doc.c_str()));
  else
    scope.attr(name) = py::staticmethod(
        py::cpp_function(call, py::name(name), py::scope(scope), py::doc(doc.c_str())));
}

}  // namespace clpv::python
