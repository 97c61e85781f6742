// SPDX-License-Identifier: MIT
// Device memory that counts as in use for as long as someone holds it.
#pragma once

#include <CL/opencl.hpp>
#include <cstddef>
#include <memory>
#include <utility>

namespace clpv {

/// Bytes of a session's memory in use, and the most there ever were at once.
struct MemoryUse {
  std::size_t now = 0, most = 0;
};

/// Bytes in use while this lives. The count is shared: memory may outlive its session.
class MemoryShare {
 public:
  MemoryShare(std::shared_ptr<MemoryUse> use, std::size_t bytes) : use_(std::move(use)), bytes_(bytes) {
    use_->now += bytes_;
    if (use_->now > use_->most) use_->most = use_->now;
  }
  ~MemoryShare() { use_->now -= bytes_; }
  MemoryShare(const MemoryShare&) = delete;
  MemoryShare& operator=(const MemoryShare&) = delete;

  std::size_t bytes() const { return bytes_; }

 private:
  std::shared_ptr<MemoryUse> use_;
  std::size_t bytes_;
};

/// A buffer or an image, or none. Copies are the same memory, which is given back with the last of them; the device
/// keeps it until commands that were enqueued with it are done.
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
