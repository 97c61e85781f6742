// SPDX-License-Identifier: MIT
// OpenCL objects given from Python.
#pragma once

#include <cstdint>

#include "clpv/opencl.hpp"
#include "module.hpp"

namespace clpv::python {

/// Classes of pyopencl for the objects that calls take.
inline constexpr const char* kContextClass = "Context";
inline constexpr const char* kQueueClass = "CommandQueue";
inline constexpr const char* kMemoryClass = "MemoryObjectHolder";  ///< base of Buffer and Image

/// True if a class of that name is the object's, or one of its bases.
inline bool is_of_class(const py::object& given, const char* name) {
  for (const py::handle& type : py::type::of(given).attr("__mro__"))
    if (type.attr("__name__").cast<std::string>() == name) return true;
  return false;
}

/// The buffer of an array of pyopencl; another object as it is. Throws Error(usage) for an array
/// that is not of float32 or float4 from the start of its buffer, row by row.
inline py::object buffer_of(const py::object& given, const char* what) {
  if (!py::hasattr(given, "base_data") || !is_of_class(given, "Array")) return given;
  const py::object type = given.attr("dtype");
  const auto number = type.attr("base").attr("kind").cast<std::string>();
  const auto bytes = type.attr("itemsize").cast<std::size_t>();
  const bool floats = (number == "f" && bytes == 4) || (number == "V" && bytes == 16);
  const auto offset = given.attr("offset").cast<std::size_t>();
  const bool rows = given.attr("flags").attr("c_contiguous").cast<bool>();
  if (!floats || offset != 0 || !rows)
    throw Error(ExitCode::usage,
                "{}: found an array of {} from byte {} on, {}contiguous, allowed: of float32 or "
                "float4 from byte 0 on, contiguous",
                what, std::string(py::str(type)), offset, rows ? "" : "not ");
  return given.attr("base_data");
}

/// Handle of an object of pyopencl, which has int_ptr, or of an integer, which is trusted; null for
/// None. An object of another class is rejected, since drivers crash on a handle of another kind.
/// Throws Error(usage).
template <typename Handle>
Handle handle_of(const py::object& given, const char* what, const char* pyopencl_class) {
  if (given.is_none()) return nullptr;
  const py::object from = std::is_same_v<Handle, cl_mem> ? buffer_of(given, what) : given;
  const bool object = py::hasattr(from, "int_ptr") && is_of_class(from, pyopencl_class);
  if (!object && !py::isinstance<py::int_>(from)) {
    throw Error(ExitCode::usage,
                "{}: found {}, allowed: an object of pyopencl's class {}, or its int_ptr", what,
                std::string(py::str(py::type::of(given))), pyopencl_class);
  }
  const py::object number = object ? py::object(from.attr("int_ptr")) : from;
  return reinterpret_cast<Handle>(number.cast<std::uintptr_t>());
}

}  // namespace clpv::python
