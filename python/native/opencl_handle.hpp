// SPDX-License-Identifier: MIT
// OpenCL objects given from Python.
#pragma once

#include <cstdint>

#include "module.hpp"

namespace clpv::python {

/// Handle of an object with int_ptr (pyopencl's have it) or of an integer; null for None. Throws
/// TypeError.
template <typename Handle>
Handle handle_of(const py::object& given, const char* what) {
  if (given.is_none()) return nullptr;
  const py::object number =
      py::hasattr(given, "int_ptr") ? py::object(given.attr("int_ptr")) : given;
  if (!py::isinstance<py::int_>(number)) {
    throw py::type_error(std::string(what) + ": found " +
                         std::string(py::str(py::type::of(given))) +
                         ", allowed: an OpenCL object of pyopencl, or its int_ptr");
  }
  return reinterpret_cast<Handle>(number.cast<std::uintptr_t>());
}

}  // namespace clpv::python
