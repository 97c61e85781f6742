// SPDX-License-Identifier: MIT
// Device memory with reference-counted accounting of bytes in use.
#pragma once

#include <CL/opencl.hpp>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "device/device.hpp"
#include "support/error.hpp"

namespace clpv {

// OpenCL objects of a caller, checked.

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

/// Bytes of device memory in use by a session: now and at the peak.
struct MemoryUse {
  std::size_t now = 0, peak = 0;
};

/// Counts `bytes` as in use during its lifetime. The counter is shared because memory may outlive
/// its session.
class MemoryShare {
 public:
  MemoryShare(std::shared_ptr<MemoryUse> use, std::size_t bytes)
      : use_(std::move(use)), bytes_(bytes) {
    use_->now += bytes_;
    if (use_->now > use_->peak) use_->peak = use_->now;
  }
  ~MemoryShare() { use_->now -= bytes_; }
  MemoryShare(const MemoryShare&) = delete;
  MemoryShare& operator=(const MemoryShare&) = delete;

  std::size_t bytes() const { return bytes_; }
  std::uint64_t number() const { return number_; }  ///< which no other has

 private:
  static std::uint64_t next() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
  }
  std::shared_ptr<MemoryUse> use_;
  std::size_t bytes_;
  std::uint64_t number_ = next();
};

/// A buffer, an image, or empty. Copies share the memory; the last copy releases it. The device
/// keeps it until enqueued commands that use it are done.
template <typename Handle>
class DeviceMemory {
 public:
  DeviceMemory() = default;
  DeviceMemory(Handle handle, std::shared_ptr<const MemoryShare> share)
      : handle_(std::move(handle)), share_(std::move(share)) {}

  bool exists() const { return share_ != nullptr; }
  std::size_t bytes() const { return share_ ? share_->bytes() : 0; }
  std::uint64_t number() const { return share_ ? share_->number() : 0; }
  const Handle& handle() const { return handle_; }

 private:
  Handle handle_;
  std::shared_ptr<const MemoryShare> share_;
};

using Buffer = DeviceMemory<cl::Buffer>;
using Image3D = DeviceMemory<cl::Image3D>;

/// More memory or numbers than the device allows.
struct TooLarge : Error {
  TooLarge(Error error, double share) : Error(std::move(error)), share(share) {}
  double share;  ///< allowed by the device / needed (in use + requested), below 1
};

}  // namespace clpv
