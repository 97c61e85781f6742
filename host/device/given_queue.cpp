// SPDX-License-Identifier: MIT
#include "device/given_queue.hpp"

#include "device/cl_error.hpp"

namespace clpv {
namespace {

/// Returns `query()`; an object that its driver rejects is an error of the caller.
template <typename Query>
auto asked(const char* what, const char* wanted, const Query& query) {
  try {
    return query();
  } catch (const cl::Error& error) {
    throw Error(ExitCode::usage, "{}: found an object that {} rejects with {}, allowed: {}", what,
                error.what(), cl_error_name(error.err()), wanted);
  }
}

cl::CommandQueue only_devices_queue(const cl::Context& context) {
  const auto devices =
      asked("context", "a context", [&] { return context.getInfo<CL_CONTEXT_DEVICES>(); });
  if (devices.size() != 1) {
    throw Error(
        ExitCode::usage,
        "context: found {} devices and no queue, allowed: one device, or a queue for one of them",
        devices.size());
  }
  const bool profiling = device_of(devices[0]).profiling_valid;
  return {context, devices[0],
          cl_command_queue_properties{profiling ? CL_QUEUE_PROFILING_ENABLE : 0u}};
}

}  // namespace

GivenQueue given_queue(cl_context context, cl_command_queue queue) {
  if (context == nullptr && queue == nullptr)
    throw Error(ExitCode::usage, "context and queue: found neither, allowed: one of them or both");
  GivenQueue given;
  if (queue == nullptr) {
    given.queue = only_devices_queue(
        asked("context", "a context", [&] { return cl::Context(context, true); }));
  } else {
    given.queue = asked("queue", "a command queue", [&] { return cl::CommandQueue(queue, true); });
  }
  const auto of_queue = [&]<cl_command_queue_info info>() {
    return asked("queue", "a command queue", [&] { return given.queue.getInfo<info>(); });
  };
  given.context = of_queue.operator()<CL_QUEUE_CONTEXT>();
  if (context != nullptr && given.context() != context)
    throw Error(ExitCode::usage,
                "queue: found one of another context, allowed: one of the context given");
  const auto properties = of_queue.operator()<CL_QUEUE_PROPERTIES>();
  if ((properties & CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE) != 0)
    throw Error(ExitCode::usage, "queue: found an out-of-order one, allowed: an in-order queue");
  given.device = device_of(of_queue.operator()<CL_QUEUE_DEVICE>());
  if (!given.device.supported()) {
    throw Error(ExitCode::device, "queue: found one of {} ({}), which lacks: {}", given.device.name,
                given.device.platform, fmt::join(given.device.missing, ", "));
  }
  given.device.profiling_valid =
      given.device.profiling_valid && (properties & CL_QUEUE_PROFILING_ENABLE) != 0;
  return given;
}

cl::Buffer given_buffer(const cl::Context& context, cl_mem memory, std::size_t bytes,
                        const char* what) {
  if (memory == nullptr) throw Error(ExitCode::usage, "{}: found none, allowed: a buffer", what);
  const cl::Buffer buffer = asked(what, "a buffer", [&] { return cl::Buffer(memory, true); });
  const auto of_buffer = [&]<cl_mem_info info>() {
    return asked(what, "a buffer", [&] { return buffer.getInfo<info>(); });
  };
  if (of_buffer.operator()<CL_MEM_TYPE>() != CL_MEM_OBJECT_BUFFER)
    throw Error(ExitCode::usage, "{}: found an image, allowed: a buffer", what);
  if (of_buffer.operator()<CL_MEM_CONTEXT>()() != context())
    throw Error(ExitCode::usage,
                "{}: found a buffer of another context, allowed: one of the renderer's", what);
  if (const std::size_t found = of_buffer.operator()<CL_MEM_SIZE>(); found < bytes)
    throw Error(ExitCode::usage, "{}: found {} bytes, allowed: at least {}", what, found, bytes);
  return buffer;
}

}  // namespace clpv
