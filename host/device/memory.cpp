// SPDX-License-Identifier: MIT
// Memory of a session.
#include "device/memory.hpp"

#include <fmt/ranges.h>

#include <algorithm>

#include "device/cl_error.hpp"
#include "device/session.hpp"

namespace clpv {
namespace {

double mib(std::size_t bytes) {
  return static_cast<double>(bytes) / (1 << 20);
}

}  // namespace

std::size_t Session::largest_buffer() const {
  const std::uint64_t left =
      device_.memory_bytes > use_->now ? device_.memory_bytes - use_->now : 0;
  return std::min<std::uint64_t>(device_.max_alloc_bytes, left);
}

void Session::require_room(std::size_t bytes, const std::string& what) const {
  if (bytes <= largest_buffer()) return;
  const auto share = [](std::uint64_t allowed, std::size_t needed) {
    return static_cast<double>(allowed) / static_cast<double>(needed);
  };
  throw TooLarge(Error(ExitCode::run_time,
                       "{} needs {:.1f} MiB, but a buffer on {} can have at most {:.1f} MiB (limit "
                       "of one buffer: {:.1f} MiB; memory: {:.1f} MiB, {:.1f} MiB of it in use): "
                       "try a smaller grid, rsm-size or image",
                       what, mib(bytes), device_.name, mib(largest_buffer()),
                       mib(device_.max_alloc_bytes), mib(device_.memory_bytes), mib(use_->now)),
                 std::min(share(device_.max_alloc_bytes, bytes),
                          share(device_.memory_bytes, use_->now + bytes)));
}

Buffer Session::buffer(std::size_t bytes, const std::string& what) {
  bytes = std::max<std::size_t>(bytes, 4);
  require_room(bytes, what);
  try {
    const Buffer made(cl::Buffer(context_, CL_MEM_READ_WRITE, bytes),
                      std::make_shared<MemoryShare>(use_, bytes));
    if (zeroed_) queue_.enqueueFillBuffer(made.handle(), cl_uchar{0}, 0, bytes);
    // Oclgrind 21.10's memory checker confuses a new buffer at a freed address with the old one and
    // its size.
    if (device_.oclgrind()) retained_.push_back(made);
    return made;
  } catch (const cl::Error& error) {
    throw cl_error(error, fmt::format("{} ({:.1f} MiB) on {}", what, mib(bytes), device_.name));
  }
}

Buffer Session::part(const Buffer& whole, std::size_t from, std::size_t bytes) const {
  const cl_buffer_region region{from, bytes};
  cl::Buffer buffer = whole.handle();
  return {buffer.createSubBuffer(CL_MEM_READ_WRITE, CL_BUFFER_CREATE_TYPE_REGION, &region),
          std::make_shared<MemoryShare>(use_, 0)};
}

void Session::reserve(Buffer& buffer, std::size_t bytes, const std::string& what) {
  if (buffer.exists() && buffer.bytes() >= bytes) return;
  buffer = {};  // first: memory may not suffice for both
  buffer = this->buffer(bytes, what);
}

Image3D Session::image(const cl::ImageFormat& texel, const std::array<std::size_t, 3>& extent,
                       std::size_t bytes, const std::string& what) {
  require_room(bytes, what);
  try {
    return {cl::Image3D(context_, CL_MEM_READ_WRITE, texel, extent[0], extent[1], extent[2]),
            std::make_shared<MemoryShare>(use_, bytes)};
  } catch (const cl::Error& error) {
    throw cl_error(error, fmt::format("{} (an image of {} texels) on {}", what,
                                      fmt::join(extent, " x "), device_.name));
  }
}

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
