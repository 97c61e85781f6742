// SPDX-License-Identifier: MIT
// Functions of the Python module whose arguments are checked one by one: an error names function,
// argument, value found and value allowed. pybind11 alone lists all signatures.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "support/error.hpp"

namespace clpv::python {

namespace py = pybind11;

/// A call of the module. Exists while the GIL is held, before and after. Python's exit waits for
/// all of them: a thread that asked for the GIL later, as NumPy does for a copy, would be ended
/// inside C++, whose destructors would touch objects without the GIL. Once Python exits, the
/// constructor ends other threads.
class CallInProgress {
 public:
  CallInProgress();
  ~CallInProgress();
  CallInProgress(const CallInProgress&) = delete;
  CallInProgress& operator=(const CallInProgress&) = delete;
};

/// The message of a UsageError; empty for other exceptions.
std::string usage_message(const py::error_already_set& error);

struct Parameter {
  const char* name;
  bool required, keyword;           ///< keyword: by name only
  std::string (*allowed)();         ///< "a number or None"
  bool (*takes)(py::handle given);  ///< true if it converts to the parameter's type
  bool any = true;                  ///< any object, which the function converts itself
};

/// Throws Error(usage) unless the function takes these arguments, which become plain(). `open`: it
/// takes any keywords.
void check_call(const std::string& function, const std::vector<Parameter>& parameters, bool open,
                py::list& args, py::dict& kwargs);

/// Arrays and columns of tables as lists in the order of their items, since subscripts of a column
/// of pandas are labels; lists and tuples of them too, so that a box has two levels. Other objects
/// as they are.
py::object plain(const py::object& given, int levels = 2);

/// A value for a message: short ones as Python writes them, others by their type.
std::string found(py::handle given);

/// True for NumPy's masked arrays, whose hidden numbers would count. Tables of pandas have a method
/// `mask` too.
bool is_masked(py::handle given);

/// False for complex numbers and NumPy's masked ones, which become floats with a warning. Raises
/// what the object's __float__ raises.
bool is_real(py::handle given);

template <typename T>
bool takes(py::handle given);

/// The values that a parameter of a type allows, in words.
template <typename T>
struct Kind {
  static std::string text() {
    if constexpr (std::is_same_v<T, bool>) return "True or False";
    if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
      return fmt::format("an integer, {}..{}", std::numeric_limits<T>::min(),
                         std::numeric_limits<T>::max());
    if constexpr (std::is_floating_point_v<T>) return "a number";
    if constexpr (std::is_same_v<T, std::string>) return "a text";
    if constexpr (std::is_same_v<T, std::filesystem::path>) return "a path";
    if constexpr (std::is_same_v<T, py::function>) return "a function";
    if constexpr (std::is_class_v<T>)
      if (const py::handle type = py::detail::get_type_handle(typeid(T), false))
        return "clpv." + type.attr("__name__").cast<std::string>();
    return "any object";
  }
};
template <typename T>
struct Kind<std::optional<T>> {
  static std::string text() { return Kind<T>::text() + " or None"; }
};
template <typename T, std::size_t n>
struct Kind<std::array<T, n>> {
  static std::string text() { return fmt::format("{} of: {}", n, Kind<T>::text()); }
};
template <std::size_t n>
struct Kind<std::array<double, n>> {
  static std::string text() { return fmt::format("{} numbers", n); }
};
template <typename T>
struct Kind<std::vector<T>> {
  static std::string text() { return "a sequence of: " + Kind<T>::text(); }
};
template <typename T, typename... More>
struct Kind<std::variant<T, More...>> {
  static std::string text() { return (Kind<T>::text() + ... + (" or " + Kind<More>::text())); }
};

/// False for what pybind11 would convert and the kind's words exclude: bool as an integer, any
/// object as bool, bytes as text, complex and masked numbers.
template <typename T>
struct Strictly {
  static bool is(py::handle given) {
    if constexpr (std::is_same_v<T, bool>)
      return py::detail::make_caster<bool>().load(given, false);
    else if constexpr (std::is_integral_v<T>)
      return !py::isinstance<py::bool_>(given);
    else if constexpr (std::is_floating_point_v<T>)
      return is_real(given);
    else if constexpr (std::is_same_v<T, std::string>)
      return py::isinstance<py::str>(given);
    else
      return true;
  }
};
template <typename T>
struct Strictly<std::optional<T>> {
  static bool is(py::handle given) { return given.is_none() || takes<T>(given); }
};
template <typename... T>
struct Strictly<std::variant<T...>> {
  static bool is(py::handle given) { return (takes<T>(given) || ...); }
};
template <typename T>
struct StrictItems {
  static bool is(py::handle given) {
    if (!py::isinstance<py::sequence>(given) || py::isinstance<py::str>(given)) return false;
    for (const py::object item :
         py::reinterpret_borrow<py::sequence>(given))  // may exist only here
      if (!takes<T>(item)) return false;
    return true;
  }
};
template <typename T>
struct Strictly<std::vector<T>> : StrictItems<T> {};
template <typename T, std::size_t n>
struct Strictly<std::array<T, n>> : StrictItems<T> {};

template <typename T>
bool takes(py::handle given) {
  try {
    if (!Strictly<std::remove_cvref_t<T>>::is(given)) return false;
    py::detail::make_caster<T> caster;
    if (!caster.load(given, true)) return false;
    static_cast<void>(py::detail::cast_op<T>(caster));  // rejects None for a reference
    return true;
  } catch (const py::reference_cast_error&) {
    return false;
  } catch (const py::error_already_set& error) {  // by the object's own methods
    if (!error.matches(PyExc_Exception)) throw;   // such as KeyboardInterrupt
    return false;
  }
}

/// The argument of a property, converted. Throws Error(usage).
template <typename T>
T argument(const char* name, const py::object& given) {
  if (const py::object values = plain(given); takes<T>(values)) return values.cast<T>();
  throw Error(ExitCode::usage, "{}: found {}, allowed: {}", name, found(given), Kind<T>::text());
}

/// Types of a function's arguments.
template <typename Function>
struct ArgumentsOf : ArgumentsOf<decltype(&Function::operator())> {};
template <typename Result, typename... Args>
struct ArgumentsOf<Result (*)(Args...)> {
  using Types = std::tuple<std::type_identity<Args>...>;
};
template <typename Result, typename Class, typename... Args>
struct ArgumentsOf<Result (Class::*)(Args...) const> {
  using Types = std::tuple<std::type_identity<Args>...>;
};

enum class Self { none, typed, untyped };  ///< untyped: of __init__, whose object is not made yet

/// Parameters of a function with the names that py::arg gives, and true if it has **kwargs.
template <typename Function, typename... Extra>
std::pair<std::vector<Parameter>, bool> parameters_of(Self self, const Extra&... extra) {
  std::vector<Parameter> all;
  if (self != Self::none) all.push_back({"self", true, false, nullptr, nullptr});
  bool keyword = false, open = false;
  const auto add = [&](const auto& given) {
    using Given = std::decay_t<decltype(given)>;
    if constexpr (std::is_same_v<Given, py::kw_only>) keyword = true;
    if constexpr (std::is_base_of_v<py::arg, Given>)
      all.push_back({given.name, !std::is_same_v<Given, py::arg_v>, keyword, nullptr, nullptr});
  };
  (add(extra), ...);
  std::size_t i = self == Self::untyped ? 1 : 0;
  const auto type = [&]<typename T>(std::type_identity<T>) {
    using Bare = std::remove_cvref_t<T>;
    if constexpr (std::is_same_v<Bare, py::kwargs>) {
      open = true;
    } else {
      all.at(i).any = std::is_same_v<Bare, py::object>;
      all.at(i).allowed = &Kind<Bare>::text;
      all.at(i++).takes = &takes<T>;
    }
  };
  std::apply([&](const auto&... types) { (type(types), ...); },
             typename ArgumentsOf<std::decay_t<Function>>::Types());
  return {all, open};
}

/// Replaces function `name` of a class or module by one that checks its arguments first.
void check_arguments(const py::object& scope, const char* name, Self self,
                     const std::pair<std::vector<Parameter>, bool>& parameters);

/// Scope::def with checked arguments.
template <typename Scope, typename Function, typename... Extra>
void define(Scope& scope, const char* name, const Function& function, const Extra&... extra) {
  constexpr Self self = std::is_same_v<Scope, py::module_> ? Self::none : Self::typed;
  scope.def(name, function, extra...);
  check_arguments(scope, name, self, parameters_of<Function>(self, extra...));
}

/// class_::def_static with checked arguments.
template <typename Type, typename Function, typename... Extra>
void define_static(Type& type, const char* name, const Function& function, const Extra&... extra) {
  type.def_static(name, function, extra...);
  check_arguments(type, name, Self::none, parameters_of<Function>(Self::none, extra...));
}

/// The constructor by a factory function, with checked arguments.
template <typename Type, typename Function, typename... Extra>
void define_init(Type& type, const Function& factory, const Extra&... extra) {
  type.def(py::init(factory), extra...);
  check_arguments(type, "__init__", Self::untyped,
                  parameters_of<Function>(Self::untyped, extra...));
}

}  // namespace clpv::python
