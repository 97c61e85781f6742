// SPDX-License-Identifier: MIT
// OpenCL's error codes by name, and its exceptions in the user's words.
#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "support/error.hpp"

namespace clpv {

/// "CL_OUT_OF_RESOURCES (-5)"; "code -9999" for one that devices and drivers do not give of themselves.
std::string cl_error_name(cl_int code);

/// `error` as an Error: the call that failed, the code's name, what may help. `doing` (may be empty) is what
/// it was for: "kernel 'gather' on NAME". Exit code: device where the device is not there (any more) or lacks
/// something, else run_time.
Error cl_error(const cl::Error& error, const std::string& doing = {});

}  // namespace clpv
