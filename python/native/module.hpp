// SPDX-License-Identifier: MIT
// Parts of the Python module clpv, and conversions that several of them use.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <concepts>
#include <cstring>
#include <filesystem>
#include <future>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <variant>
#include <vector>

#include "basis/basis.hpp"
#include "clpv/compare.hpp"
#include "clpv/image.hpp"
#include "clpv/opencl.hpp"
#include "clpv/renderer.hpp"
#include "clpv/scene.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"

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

/// Returns the message of a UsageError, or pybind11's for arguments that do not fit a function, as
/// value found and value allowed; empty for other exceptions.
std::string usage_message(const py::error_already_set& error);

/// A column of a table as a list in the order of its items, since its subscripts may be labels.
/// Other objects as they are.
inline py::object plain(const py::handle& given) {
  const bool column = PySequence_Check(given.ptr()) && py::hasattr(given, "tolist");
  return column ? given.attr("tolist")() : py::reinterpret_borrow<py::object>(given);
}

/// A value for a message: short ones as Python writes them, others by their type.
std::string found(py::handle given);

/// True for NumPy's masked arrays, whose hidden numbers would count. Tables of pandas have a method
/// `mask` too.
bool is_masked(py::handle given);

/// The value of a property, converted. Throws Error(usage).
template <typename T>
T argument(const char* name, const py::object& given, const char* allowed) {
  try {
    return given.cast<T>();
  } catch (const py::cast_error&) {
    throw Error(ExitCode::usage, "{}: found {}, allowed: {}", name, found(given), allowed);
  }
}

enum class Self { none, typed, untyped };  ///< untyped: of __init__, whose object is not made yet

/// Replaces function `name` of a class or module by one whose errors begin with its name.
void name_errors(const py::object& scope, const char* name, Self self);

/// Scope::def with errors that begin with the function's name.
template <typename Scope, typename Function, typename... Extra>
void define(Scope& scope, const char* name, const Function& function, const Extra&... extra) {
  constexpr Self self = std::is_same_v<Scope, py::module_> ? Self::none : Self::typed;
  scope.def(name, function, extra...);
  name_errors(scope, name, self);
}

/// class_::def_static, likewise.
template <typename Type, typename Function, typename... Extra>
void define_static(Type& type, const char* name, const Function& function, const Extra&... extra) {
  type.def_static(name, function, extra...);
  name_errors(type, name, Self::none);
}

/// The constructor by a factory function, likewise.
template <typename Type, typename Function, typename... Extra>
void define_init(Type& type, const Function& factory, const Extra&... extra) {
  type.def(py::init(factory), extra...);
  name_errors(type, "__init__", Self::untyped);
}

void add_errors(py::module_& module);
void add_scene(py::module_& module);
void add_material(py::module_& module);
void add_meshes(py::class_<Scene>& type);
/// Adds replace(), copies and pickling to a class of immutable values, given its constructor's
/// arguments, which are also its attributes.
void add_copies(const py::object& type, const std::vector<const char*>& members);
void add_points(py::class_<Scene>& type);
/// Number of bounces, 0 for 'all'. Throws Error(usage) for another text.
int bounces_of(const std::variant<int, std::string>& given);
void add_image(py::module_& module);
void add_renderer(py::module_& module);
void add_opencl(py::module_& module);  ///< after add_renderer()
void add_basis(py::module_& module);

using FloatArray = py::array_t<float, py::array::c_style | py::array::forcecast>;
using DoubleArray = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The shape of an array, as Python writes it.
inline std::string shape_text(const py::array& array) {
  return py::str(array.attr("shape"));
}

/// An array of another type of numbers. Raises what NumPy raises: a warning that is an error, or
/// MemoryError.
template <typename Array>
Array converted(const py::array& array) {
  return Array(static_cast<const py::object&>(array));
}

/// Converts anything that NumPy accepts as an array of real numbers, also numbers that are objects;
/// copies only if it must. Throws Error(usage) otherwise.
template <typename Array>
Array real_array(const py::object& given, const char* what) {
  const bool masked = is_masked(given);
  py::array any = masked ? py::array() : py::array::ensure(given);
  if (any && any.dtype().kind() == 'O' && any.size() > 0)
    any = py::array::ensure(any.attr("tolist")());  // by the types of its items; text is none
  if (masked || !any ||
      std::string_view("fiub").find(any.dtype().kind()) == std::string_view::npos) {
    throw Error(ExitCode::usage, "{}: found {}, allowed: an array of real numbers", what,
                masked                  ? "a masked array"
                : any && any.ndim() > 0 ? "an array of " + std::string(py::str(any.dtype()))
                                        : found(given));
  }
  return converted<Array>(any);
}

/// Like real_array(), for vectors of three: shape (..., 3).
template <typename Array>
Array vectors(const py::object& given, const char* what) {
  Array array = real_array<Array>(given, what);
  if (array.ndim() > 0 && array.shape(array.ndim() - 1) == 3) return array;
  throw Error(ExitCode::usage, "{}: found shape {}, allowed: (..., 3)", what, shape_text(array));
}

/// The shape of vectors(), with the last axis replaced.
inline std::vector<py::ssize_t> shape_with_last(const py::array& vectors, py::ssize_t last) {
  std::vector<py::ssize_t> shape(vectors.shape(), vectors.shape() + vectors.ndim());
  shape.back() = last;
  return shape;
}

/// An array that owns `values`, without a copy.
inline py::array_t<float> array_of(std::vector<float> values,
                                   const std::vector<py::ssize_t>& shape) {
  auto owned = std::make_unique<std::vector<float>>(std::move(values));
  const float* data = owned->data();
  const py::capsule owner(owned.release(),
                          [](void* p) { delete static_cast<std::vector<float>*>(p); });
  return py::array_t<float>(shape, data, owner);
}

using Vectors = std::span<const std::array<float, 3>>;

/// The vectors of vectors().
inline Vectors span_of(const FloatArray& array) {
  return {reinterpret_cast<const std::array<float, 3>*>(array.data()),
          static_cast<std::size_t>(array.size()) / 3};
}

inline py::array_t<float> array_of(Vectors values, const std::vector<py::ssize_t>& shape) {
  py::array_t<float> result(shape);
  if (!values.empty()) std::memcpy(result.mutable_data(), values.data(), values.size_bytes());
  return result;
}

/// Red, green, blue; or one number for all of them.
using Colour = std::variant<double, Vec3>;
Vec3 colour_of(const Colour& given);

inline py::tuple tuple_of(const Vec3& v) {
  return py::make_tuple(v[0], v[1], v[2]);
}

/// A call that may release the GIL and works with a device or threads. The constructor throws
/// Error(run_time) once Python exits, and in a process forked from one that has used a device,
/// whose threads a fork does not copy. The destructor hands messages to Python's logging.
class RunningCall {
 public:
  RunningCall();
  ~RunningCall();
  RunningCall(const RunningCall&) = delete;
  RunningCall& operator=(const RunningCall&) = delete;

 private:
  CallInProgress in_progress_;
};

/// Returns true once Python exits: running calls end at their next step.
bool exit_stops_calls();

/// Hands messages of the library to Python's logging, whose code runs only on Python's threads:
/// those of calls in progress, now and then and at the end.
void log_messages();

/// Marks this process as one that uses a device or the path tracer, and thus threads.
void note_device_use();
/// Returns true in a process forked from a marked one.
bool forked_from_device_use();

/// Runs a short `action` without the GIL.
template <typename Action>
auto without_gil(const Action& action) {
  const RunningCall call;
  py::gil_scoped_release released;
  return action();
}

/// Runs `work` on another thread without the GIL, so that Python can handle signals meanwhile.
/// After Ctrl-C the work ends at its next step, and the signal's exception is raised. `poll` runs
/// with the GIL, on the caller's thread, now and then and at the end; an exception of it ends the
/// work too. Ends this call's work only.
template <typename Work, typename Poll>
auto interruptible(const Work& work, const Poll& poll) {
  const RunningCall call;
  py::gil_scoped_release released;
  StopRequest stop{false};
  auto result = std::async(std::launch::async, [&] {
    const StopScope scope(&stop);
    return work();
  });
  while (result.wait_for(std::chrono::milliseconds(20)) != std::future_status::ready) {
    if (exit_stops_calls()) stop = true;
    py::gil_scoped_acquire acquired;
    std::optional<py::error_already_set> raised;
    if (PyErr_CheckSignals() != 0) {
      raised.emplace();
    } else {
      try {
        log_messages();
        poll();
      } catch (const py::error_already_set& error) {
        raised = error;
      }
    }
    if (!raised) continue;
    {
      py::gil_scoped_release waiting;
      stop = true;
      result.wait();
    }
    throw *raised;
  }
  py::gil_scoped_acquire acquired;
  log_messages();
  poll();
  return result.get();
}

template <typename Work>
auto interruptible(const Work& work) {
  return interruptible(work, [] {});
}

/// Converts arguments of type T. Unlike pybind11's, rejects objects made by __new__ without
/// __init__, which hold no T.
template <typename T>
class InitialisedCaster : public py::detail::type_caster_base<T> {
 public:
  bool load(py::handle source, bool convert) {
    if (py::isinstance<T>(source)) {
      auto* object = reinterpret_cast<py::detail::instance*>(source.ptr());
      const auto* type = py::detail::get_type_info(typeid(T));
      if (!object->get_value_and_holder(type).holder_constructed()) {
        throw Error(ExitCode::usage, "{}: __init__ was not called",
                    std::string(py::str(py::type::of(source).attr("__name__"))));
      }
    }
    return py::detail::type_caster_base<T>::load(source, convert);
  }
};

struct PythonFrame;
struct PythonVolume;

template <typename T, typename... Classes>
concept OneOf = (std::same_as<T, Classes> || ...);
/// Classes of the module.
template <typename T>
concept Wrapped = OneOf<T, Basis, Camera, Comparison, Image, Light, Material, Medium, Renderer,
                        Scene, opencl::Event, opencl::Volumes, PythonFrame, PythonVolume>;

}  // namespace clpv::python

namespace pybind11::detail {

template <clpv::python::Wrapped T>
class type_caster<T> : public clpv::python::InitialisedCaster<T> {};

}  // namespace pybind11::detail
