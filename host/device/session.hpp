// SPDX-License-Identifier: MIT
// A session on one device: context, in-order queue, stage times, programs and memory.
#pragma once

#include <CL/opencl.hpp>
#include <array>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "device/memory.hpp"
#include "device/programs.hpp"
#include "device/recorder.hpp"
#include "device/timeline.hpp"
#include "support/error.hpp"

namespace clpv {

/// One open device. All commands go to one in-order queue. Not thread safe: use one session per
/// thread.
class Session {
 public:
  /// `cache`: source of compiled programs and target of Programs::store(). Without one every
  /// program is compiled. `times`: if false, stages have no times, and commands no events.
  explicit Session(Device device, std::optional<ProgramCache> cache = std::nullopt,
                   Compilation compilation = {}, bool times = true);
  /// In a caller's context and queue. Stages have times only if the queue has profiling.
  explicit Session(GivenQueue given, std::optional<ProgramCache> cache = std::nullopt);
  /// Waits for all enqueued commands.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Records all that follows in `folder`. Buffers then start with zeros. Requires that nothing is
  /// built yet.
  void record(const std::filesystem::path& folder);
  /// Null unless the session records.
  Recorder* recorder() { return recorder_.get(); }

  const Device& device() const { return device_; }
  cl::Context& context() { return context_; }
  cl::CommandQueue& queue() { return queue_; }
  Timeline& timeline() { return timeline_; }
  Programs& programs() { return programs_; }
  const Programs& programs() const { return programs_; }

  /// Waits for the queue, whose kernels may be compiled meanwhile, and counts the wait.
  void finish() {
    timeline_.wait([this] { queue_.finish(); }, true);
  }

  /// Allocates a buffer of max(bytes, 4) bytes with undefined contents. `what` names it in errors.
  /// Throws Error(run_time), before allocating, if the device's memory does not suffice; it states
  /// the limit.
  Buffer buffer(std::size_t bytes, const std::string& what);
  /// A caller's buffer, whose memory does not count as the session's. Throws as given_buffer().
  Buffer given(cl_mem memory, std::size_t bytes, const char* what) const {
    return {given_buffer(context_, memory, bytes, what), std::make_shared<MemoryShare>(use_, 0)};
  }
  /// Part of a buffer from byte `from` on, a multiple of CL_DEVICE_MEM_BASE_ADDR_ALIGN. Kernels see
  /// what others wrote to the whole, and the reverse.
  Buffer part(const Buffer& whole, std::size_t from, std::size_t bytes) const;
  /// Replaces `buffer` by a new one with undefined contents if it has fewer than `bytes` bytes.
  void reserve(Buffer& buffer, std::size_t bytes, const std::string& what);
  /// Allocates an image of `extent` texels and `bytes` bytes with undefined contents. Throws like
  /// buffer().
  Image3D image(const cl::ImageFormat& texel, const std::array<std::size_t, 3>& extent,
                std::size_t bytes, const std::string& what);

  /// Runs `kernel` over `global` work-items, rounded up to whole work-groups of `local` in each
  /// dimension (OpenCL 1.2 has no non-uniform work-groups; kernels guard their range). Timed under
  /// the current stage.
  void launch(const cl::Kernel& kernel, const cl::NDRange& global, const cl::NDRange& local,
              Chain chain = {});
  /// Zeroes `bytes` bytes from byte `from` on; both are multiples of 4.
  void fill_zero(const Buffer& buffer, std::size_t bytes, std::size_t from = 0);
  /// Copies the first `bytes` bytes of `from` to byte `to_byte` of `to`; both are multiples of 4.
  void copy(const Buffer& from, const Buffer& to, std::size_t bytes, std::size_t to_byte = 0);

  /// Writes values, which may change after the call. Waits for the queue only if they are more than
  /// 1 MiB.
  template <typename T>
  void write(const Buffer& buffer, const std::vector<T>& values) {
    write(buffer, std::span(values), 0);
  }
  /// Overwrites elements from `first` on.
  template <typename T>
  void write(const Buffer& buffer, std::span<const T> values, std::size_t first) {
    write_bytes(buffer, std::as_bytes(values), first * sizeof(T));
  }
  template <typename T>
  Buffer upload(const std::vector<T>& values, const std::string& what) {
    Buffer made = buffer(values.size() * sizeof(T), what);
    write(made, values);
    return made;
  }
  template <typename T>
  std::vector<T> read(const Buffer& buffer, std::size_t count, std::size_t first = 0) {
    std::vector<T> values(count);
    if (count == 0) return values;
    timeline_.wait([&] {
      queue_.enqueueReadBuffer(buffer.handle(), CL_TRUE, first * sizeof(T), count * sizeof(T),
                               values.data());
    });
    return values;
  }

  /// An asynchronous read: `values` are valid once arrived() is true.
  struct Arriving {
    std::vector<cl_uint> values;
    cl::Event done;
    bool arrived() const {
      return done.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() <= CL_COMPLETE;
    }
  };
  /// Reads without waiting.
  std::shared_ptr<const Arriving> read_later(const Buffer& buffer, std::size_t count);

  /// Returns a read-only 1-D image of `values` (one channel of float) that lives as long as the
  /// session. Equal values share one image. `what` names it in errors. Requires Device::images.
  const cl::Image1DBuffer& table_image(const std::vector<float>& values, const std::string& what);

  /// Size of the largest buffer that can be allocated now [bytes].
  std::size_t largest_buffer() const;

  std::size_t device_bytes() const { return use_->now; }        ///< device memory in use
  std::size_t peak_device_bytes() const { return use_->peak; }  ///< maximum so far

 private:
  Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  Timeline timeline_;
  void write_bytes(const Buffer& buffer, std::span<const std::byte> bytes, std::size_t at);

  void require_room(std::size_t bytes, const std::string& what) const;

  std::unique_ptr<Recorder> recorder_;
  bool zeroed_ = false;           ///< new buffers start with zeros
  std::vector<Buffer> retained_;  ///< for Oclgrind, see buffer()
  std::shared_ptr<MemoryUse> use_ = std::make_shared<MemoryUse>();
  Programs programs_;
  struct Write {  ///< bytes on their way to the device
    std::vector<std::byte> bytes;
    cl::Event done;
  };
  std::vector<Write> writes_;
  std::vector<std::shared_ptr<Arriving>> reads_;  ///< by read_later(), until they arrive
  struct TableImage {
    Buffer values;
    cl::Image1DBuffer image;
  };
  std::map<std::vector<float>, TableImage> table_images_;  ///< see table_image()
};

/// Times all launches during its lifetime as one stage of the timeline.
class StageScope {
 public:
  StageScope(Session& session, StageMark mark)
      : session_(session), exceptions_(std::uncaught_exceptions()) {
    session_.timeline().begin(std::move(mark));
  }
  /// Ends the stage. Throws cl::Error, unless another exception ends the scope.
  ~StageScope() noexcept(false) {
    if (std::uncaught_exceptions() == exceptions_)
      session_.timeline().end(session_.queue());
    else
      session_.timeline().abandon();
  }
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  Session& session_;
  int exceptions_;
};

}  // namespace clpv
