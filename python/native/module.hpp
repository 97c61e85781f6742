// SPDX-License-Identifier: MIT
// Parts of the Python module clpv, and conversions that several of them use.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <future>
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
#include "options/show.hpp"
#include "scene/scene.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/named_enum.hpp"

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

/// The class of renderers. In a forked child the driver's threads are missing: releasing its
/// objects there could wait for them without end.
struct ReleaseUnlessForked {
  void operator()(Renderer* renderer) const;
};
using RendererClass = py::class_<Renderer, std::unique_ptr<Renderer, ReleaseUnlessForked>>;

void add_errors(py::module_& module);
void add_scene(py::module_& module);
void add_meshes(py::module_& module, py::class_<Scene>& type);
void add_image(py::module_& module);
void add_renderer(py::module_& module);
void add_opencl(py::module_& module, RendererClass& type);
void add_basis(py::module_& module);

/// Number of bounces, 0 for 'all'. Throws Error(usage) for another text.
int bounces_of(const std::variant<int, std::string>& given);

/// An argument that NumPy takes for an array of real numbers. Converted to T, row by row.
template <typename T>
struct Array : py::array_t<T, py::array::c_style | py::array::forcecast> {
  using Base = py::array_t<T, py::array::c_style | py::array::forcecast>;
  using Base::Base;
};
using FloatArray = Array<float>;
using DoubleArray = Array<double>;

/// The shape of an array, as Python writes it.
inline std::string shape_text(const py::array& array) {
  return py::str(array.attr("shape"));
}

/// Throws Error(usage) unless the last axis of an array has three numbers.
inline void require_vectors(const py::array& array, const char* what) {
  if (array.ndim() > 0 && array.shape(array.ndim() - 1) == 3) return;
  throw Error(ExitCode::usage, "{}: found shape {}, allowed: (..., 3)", what, shape_text(array));
}

/// The shape of an array of vectors, with the last axis replaced.
inline std::vector<py::ssize_t> shape_with_last(const py::array& vectors, py::ssize_t last) {
  std::vector<py::ssize_t> shape(vectors.shape(), vectors.shape() + vectors.ndim());
  shape.back() = last;
  return shape;
}

using Vectors = std::span<const std::array<float, 3>>;

/// The vectors of an array.
inline Vectors span_of(const FloatArray& array) {
  return {reinterpret_cast<const std::array<float, 3>*>(array.data()),
          static_cast<std::size_t>(array.size()) / 3};
}

inline py::array_t<float> array_of(Vectors values, const std::vector<py::ssize_t>& shape) {
  py::array_t<float> result(shape);
  if (!values.empty()) std::memcpy(result.mutable_data(), values.data(), values.size_bytes());
  return result;
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

/// Guard of a short call without the GIL (py::call_guard).
struct WithoutGil {
  RunningCall call = {};
  py::gil_scoped_release released = {};
};

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

/// Calls `work` with the eye or the camera that light is computed for. Throws Error(usage) for
/// both.
template <typename Work>
auto seen_from(const std::optional<Vec3>& eye, const std::optional<CameraChoice>& camera,
               const Work& work) {
  if (eye && camera)
    throw Error(ExitCode::usage, "light: found eye and camera, allowed: one of both");
  return interruptible([&] { return eye ? work(*eye) : work(camera.value_or(CameraChoice())); });
}

/// Fields of a class of python/clpv/values.py, in C++.
template <typename T>
struct Fields;

template <>
struct Fields<Camera> {
  static constexpr auto kName = py::detail::const_name("Camera");
  static constexpr auto kAll =
      std::tuple(std::pair("eye", &Camera::eye), std::pair("target", &Camera::target),
                 std::pair("up", &Camera::up), std::pair("fov", &Camera::vertical_fov_degrees),
                 std::pair("near", &Camera::near), std::pair("name", &Camera::name),
                 std::pair("light", &Camera::light));
};

template <>
struct Fields<Light> {
  static constexpr auto kName = py::detail::const_name("Light");
  static constexpr auto kAll = std::tuple(
      std::pair("kind", &Light::kind), std::pair("position", &Light::position),
      std::pair("direction", &Light::direction), std::pair("intensity", &Light::intensity),
      std::pair("range", &Light::range), std::pair("inner_cone", &Light::inner_cone_degrees),
      std::pair("outer_cone", &Light::outer_cone_degrees), std::pair("name", &Light::name));
};

template <>
struct Fields<Medium> {
  static constexpr auto kName = py::detail::const_name("Medium");
  static constexpr auto kAll = std::tuple(
      std::pair("scattering", &Medium::scattering), std::pair("absorption", &Medium::absorption),
      std::pair("anisotropy", &Medium::anisotropy), std::pair("box", &Medium::box));
};

template <>
struct Fields<Material> {
  static constexpr auto kName = py::detail::const_name("Material");
  static constexpr auto kAll = std::tuple(
      std::pair("base_colour", &Material::base_colour), std::pair("emission", &Material::emission),
      std::pair("texture", &Material::texture), std::pair("alpha_cutoff", &Material::alpha_cutoff),
      std::pair("double_sided", &Material::double_sided));
};

}  // namespace clpv::python

namespace pybind11::detail {

/// Not text, complex numbers, and masked arrays, whose hidden numbers would count. Numbers that are
/// objects, as columns of pandas have, count by their own types. Integers take no fractions.
template <typename T>
struct pyobject_caster<clpv::python::Array<T>> {
  PYBIND11_TYPE_CASTER(clpv::python::Array<T>, const_name("ArrayLike"));

  bool load(handle given, bool) {
    const bool masked = isinstance(given, module_::import("numpy.ma").attr("MaskedArray"));
    array any = masked ? array() : array::ensure(given);
    if (any && any.dtype().kind() == 'O' && any.size() > 0)
      any = array::ensure(any.attr("tolist")());
    const std::string_view kinds = std::is_integral_v<T> ? "iu" : "fiub";
    const bool real = any && (any.size() == 0 || kinds.find(any.dtype().kind()) != kinds.npos);
    if (masked || given.is_none() || !real) return false;
    value = clpv::python::Array<T>(static_cast<const object&>(any));  // raises NumPy's errors
    return true;
  }

 private:
  clpv::python::CallInProgress in_progress_;  // NumPy's copies release the GIL
};

/// A tuple. A column of a table counts in the order of its items: its subscripts may be labels.
template <>
struct type_caster<clpv::Vec3> : array_caster<clpv::Vec3, double, false, 3> {
  static constexpr auto name = const_name("Vector");

  bool load(handle given, bool convert) {
    const bool column = hasattr(given, "tolist");
    const auto items = column ? given.attr("tolist")() : reinterpret_borrow<object>(given);
    return array_caster::load(items, convert);
  }
  static handle cast(const clpv::Vec3& v, return_value_policy, handle) {
    return make_tuple(v[0], v[1], v[2]).release();
  }
};

template <>
struct type_caster<clpv::Transform>
    : array_caster<clpv::Transform, std::array<double, 4>, false, 4> {
  static constexpr auto name = const_name("ArrayLike");
};

/// An enumeration by the name of a value.
template <clpv::NamedEnum E>
struct type_caster<E> {
  PYBIND11_TYPE_CASTER(E, (const_name<std::is_same_v<E, clpv::View>>("_View", "str")));

  bool load(handle given, bool) {
    if (!isinstance<str>(given)) return false;
    value =
        clpv::named<E>(std::is_same_v<E, clpv::View> ? "view" : "kind", given.cast<std::string>());
    return true;
  }
  static handle cast(E given, return_value_policy, handle) {
    return str(std::string(clpv::name_of(given))).release();
  }
};

/// Texels as an array (height, width, 4) of uint8.
template <>
struct type_caster<clpv::Material::Texture> {
  PYBIND11_TYPE_CASTER(clpv::Material::Texture, const_name("NDArray"));

  bool load(handle given, bool) {
    const auto texels = array_t<std::uint8_t, array::c_style | array::forcecast>::ensure(given);
    if (!texels || texels.ndim() != 3 || texels.shape(2) != 4) return false;
    value = {static_cast<std::uint32_t>(texels.shape(1)),
             static_cast<std::uint32_t>(texels.shape(0)),
             {texels.data(), texels.data() + texels.size()}};
    return true;
  }
  static handle cast(const clpv::Material::Texture& given, return_value_policy, handle) {
    array_t<std::uint8_t> made({ssize_t(given.height), ssize_t(given.width), ssize_t(4)});
    std::memcpy(made.mutable_data(), given.rgba.data(), given.rgba.size());
    return made.release();
  }
};

/// Values, whose classes are Python's.
template <typename T>
requires requires {
  clpv::python::Fields<T>::kAll;
}
struct type_caster<T> {
  PYBIND11_TYPE_CASTER(T, clpv::python::Fields<T>::kName);
  using Fields = clpv::python::Fields<T>;

  static object python_class() { return module_::import("clpv.values").attr(Fields::kName.text); }
  bool load(handle given, bool) {
    if (!isinstance(given, python_class())) return false;
    const auto set = [&](const char* name, auto& member) {
      member = given.attr(name).template cast<std::decay_t<decltype(member)>>();
    };
    std::apply([&](const auto&... each) { (set(each.first, value.*each.second), ...); },
               Fields::kAll);
    return true;
  }
  static handle cast(const T& given, return_value_policy, handle) {
    const clpv::python::CallInProgress in_progress;  // Python's code below may release the GIL
    dict all;
    std::apply([&](const auto&... each) { ((all[each.first] = given.*each.second), ...); },
               Fields::kAll);
    return python_class()(**all).release();
  }
};

}  // namespace pybind11::detail
