// SPDX-License-Identifier: MIT
// OpenCL objects of a caller, checked.
#pragma once

#include <CL/opencl.hpp>

#include "device/device.hpp"

namespace clpv {

/// An in-order queue of a caller; its device has what clpv needs. `device.profiling_valid` only if
/// the queue has profiling.
struct GivenQueue {
  Device device;
  cl::Context context;
  cl::CommandQueue queue;
};

/// Checks and retains the objects of clpv/opencl.hpp. Without a queue, makes one for the context's
/// only device; without a context takes the queue's. Throws Error: usage (objects that do not fit),
/// device (a device that lacks a feature).
GivenQueue given_queue(cl_context context, cl_command_queue queue);

/// Checks and retains a buffer of a caller. `what` names it in errors. Throws Error(usage) for
/// null, an object that is no buffer, one of another context or with less than `bytes` bytes.
cl::Buffer given_buffer(const cl::Context& context, cl_mem memory, std::size_t bytes,
                        const char* what);

}  // namespace clpv
