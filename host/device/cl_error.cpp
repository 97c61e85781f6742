// SPDX-License-Identifier: MIT
#include "device/cl_error.hpp"

#include <CL/cl_ext.h>

namespace clpv {
namespace {

/// Hint for the user about a code; empty if the code's name suffices.
std::string advice(cl_int code) {
  switch (code) {
    case CL_MEM_OBJECT_ALLOCATION_FAILURE:
    case CL_OUT_OF_RESOURCES:
    case CL_OUT_OF_HOST_MEMORY:
      return "; the device is out of memory or of registers: try a smaller grid, rsm-size or image";
    case CL_DEVICE_NOT_AVAILABLE:
      return "; the device is busy, was reset or is gone";
    case CL_INVALID_WORK_GROUP_SIZE:
      return "; the kernel's work-group does not fit the device";
    default:
      return {};
  }
}

}  // namespace

std::string cl_error_name(cl_int code) {
  switch (code) {
#define CLPV_CODE(name) \
  case name:            \
    return fmt::format(#name " ({})", code);
    CLPV_CODE(CL_DEVICE_NOT_FOUND)
    CLPV_CODE(CL_DEVICE_NOT_AVAILABLE)
    CLPV_CODE(CL_COMPILER_NOT_AVAILABLE)
    CLPV_CODE(CL_MEM_OBJECT_ALLOCATION_FAILURE)
    CLPV_CODE(CL_OUT_OF_RESOURCES)
    CLPV_CODE(CL_OUT_OF_HOST_MEMORY)
    CLPV_CODE(CL_PROFILING_INFO_NOT_AVAILABLE)
    CLPV_CODE(CL_IMAGE_FORMAT_NOT_SUPPORTED)
    CLPV_CODE(CL_BUILD_PROGRAM_FAILURE)
    CLPV_CODE(CL_MAP_FAILURE)
    CLPV_CODE(CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST)
    CLPV_CODE(CL_DEVICE_PARTITION_FAILED)
    CLPV_CODE(CL_INVALID_VALUE)
    CLPV_CODE(CL_INVALID_CONTEXT)
    CLPV_CODE(CL_INVALID_COMMAND_QUEUE)
    CLPV_CODE(CL_INVALID_MEM_OBJECT)
    CLPV_CODE(CL_INVALID_IMAGE_SIZE)
    CLPV_CODE(CL_INVALID_BINARY)
    CLPV_CODE(CL_INVALID_PROGRAM_EXECUTABLE)
    CLPV_CODE(CL_INVALID_KERNEL_ARGS)
    CLPV_CODE(CL_INVALID_WORK_GROUP_SIZE)
    CLPV_CODE(CL_INVALID_WORK_ITEM_SIZE)
    CLPV_CODE(CL_INVALID_OPERATION)
    CLPV_CODE(CL_INVALID_BUFFER_SIZE)
    CLPV_CODE(CL_PLATFORM_NOT_FOUND_KHR)
#undef CLPV_CODE
    default:
      return fmt::format("code {}", code);
  }
}

Error cl_error(const cl::Error& error, const std::string& doing) {
  const cl_int code = error.err();
  const bool no_device = code == CL_DEVICE_NOT_FOUND || code == CL_PLATFORM_NOT_FOUND_KHR ||
                         code == CL_COMPILER_NOT_AVAILABLE || code == CL_IMAGE_FORMAT_NOT_SUPPORTED;
  return Error(no_device ? ExitCode::device : ExitCode::run_time, "{}{}{} failed with {}{}", doing,
               doing.empty() ? "OpenCL: " : ": ", error.what(), cl_error_name(code), advice(code));
}

}  // namespace clpv
