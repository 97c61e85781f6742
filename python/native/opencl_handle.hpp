// SPDX-License-Identifier: MIT
// OpenCL objects given from Python.
#pragma once

#include <fmt/format.h>

#include <cstdint>

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

/// Handle of an object of pyopencl, which has int_ptr, or of an integer; null for None. An object
/// of another class is rejected, since drivers crash on a handle of another kind; an integer is
/// trusted. Throws TypeError.
template <typename Handle>
Handle handle_of(const py::object& given, const char* what, const char* pyopencl_class) {
  if (given.is_none()) return nullptr;
  const bool object = py::hasattr(given, "int_ptr") && is_of_class(given, pyopencl_class);
  const py::object number = object ? py::object(given.attr("int_ptr")) : given;
  if (!py::isinstance<py::int_>(number)) {
    throw py::type_error(
        fmt::format("{}: found {}, allowed: an object of pyopencl's class {}, or its int_ptr", what,
                    std::string(py::str(py::type::of(given))), pyopencl_class));
  }
  return reinterpret_cast<Handle>(number.cast<std::uintptr_t>());
}

}  // namespace clpv::python
