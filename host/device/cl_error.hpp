// SPDX-License-Identifier: MIT
// OpenCL error codes by name, and OpenCL exceptions as clpv errors.
#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "support/error.hpp"

namespace clpv {

/// Returns "CL_OUT_OF_RESOURCES (-5)", or "code -9999" for a code that devices and drivers do not
/// return.
std::string cl_error_name(cl_int code);

/// Converts `error` into an Error that names the failed call, the code and a remedy. `doing` names
/// the purpose of the call and may be empty: "kernel 'gather' on NAME". Exit code: `device` if the
/// device is missing or lacks a feature, else `run_time`.
Error cl_error(const cl::Error& error, const std::string& doing = {});

/// Calls `command`, which calls OpenCL; its cl::Error becomes an Error.
template <typename Command>
auto named_errors(const Command& command) {
  try {
    return command();
  } catch (const cl::Error& error) {
    throw cl_error(error);
  }
}

}  // namespace clpv
