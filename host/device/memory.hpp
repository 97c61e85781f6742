// SPDX-License-Identifier: MIT
// Device memory with reference-counted accounting of bytes in use.
#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <memory>
#include <utility>

namespace clpv {

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

 private:
  std::shared_ptr<MemoryUse> use_;
  std::size_t bytes_;
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
  const Handle& handle() const { return handle_; }

 private:
  Handle handle_;
  std::shared_ptr<const MemoryShare> share_;
};

using Buffer = DeviceMemory<cl::Buffer>;
using Image3D = DeviceMemory<cl::Image3D>;

}  // namespace clpv
