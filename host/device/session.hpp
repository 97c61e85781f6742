// SPDX-License-Identifier: MIT
// A device in use: context, in-order queue, programs built so far, memory held and times taken.
#pragma once

#include <CL/opencl.hpp>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "device/memory.hpp"
#include "device/program.hpp"
#include "device/program_cache.hpp"
#include "device/timeline.hpp"

namespace clpv {

/// A program as a session knows it: described first, built when it is needed.
struct Program {
  ProgramSource source;
  std::string text, key;  ///< program_text(source), ProgramCache::key
  cl::Program built;      ///< none yet, until it is
  bool stored = false;    ///< in the cache: came from there, or was put there
};

/// One device opened for work. Everything is enqueued on one in-order queue. Not thread safe; one a thread.
class Session {
 public:
  /// `cache`: where compiled programs are looked for, and where store_programs() keeps them; none: always
  /// compiled.
  explicit Session(Device device, std::optional<ProgramCache> cache = std::nullopt);
  /// Waits for what was enqueued.
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  const Device& device() const { return device_; }
  cl::Context& context() { return context_; }
  cl::CommandQueue& queue() { return queue_; }
  Timeline& timeline() { return timeline_; }

  /// The program of this very source, which is built once in a session: by build_described(), or when a kernel of it is
  /// first asked for.
  std::shared_ptr<Program> describe(const ProgramSource& source);

  /// Builds the programs described so far that are not built yet and still wanted by someone.
  /// Throws Error(run_time) with the compiler's log; so does kernel().
  void build_described();

  /// The kernel `name` of a program of describe().
  cl::Kernel kernel(Program& program, const std::string& name);

  /// Keeps the programs compiled so far in the cache, for a tenth of the time that the process has run: the rest is left to
  /// later starts. To be called last, when results are out: on PoCL giving a program away costs about as long as its
  /// first launches, while starts without find its kernels in PoCL's own cache.
  void store_programs();

  /// A buffer of `bytes` (at least 4), its contents undefined; zeroed by fill_zero(). `what` names it in errors.
  /// Throws Error(run_time) before allocating where the device cannot hold it, and says what it could.
  Buffer buffer(std::size_t bytes, const std::string& what);
  /// Makes `buffer` one of at least `bytes`: as it is, where it is so large, else a new one, its contents undefined.
  void reserve(Buffer& buffer, std::size_t bytes, const std::string& what);
  /// An image of `bytes` in all, its contents undefined; errors as of buffer().
  Image3D image(const cl::ImageFormat& texel, const std::array<std::size_t, 3>& extent, std::size_t bytes,
                const std::string& what);

  /// Runs `kernel` over at least `global` work-items, rounded up to whole groups of `local` in each dimension
  /// (non-uniform groups do not exist in OpenCL 1.2; kernels guard their range). Timed under the current
  /// mark.
  void launch(const cl::Kernel& kernel, const cl::NDRange& global, const cl::NDRange& local);
  /// `bytes` from byte `from` on, both multiples of 4.
  void fill_zero(const Buffer& buffer, std::size_t bytes, std::size_t from = 0);
  void copy(const Buffer& from, const Buffer& to, std::size_t bytes, std::size_t to_byte = 0);

  template <typename T>
  void write(const Buffer& buffer, const std::vector<T>& values) {
    if (!values.empty())
      queue_.enqueueWriteBuffer(buffer.handle(), CL_TRUE, 0, values.size() * sizeof(T), values.data());
  }
  /// Over a part of what is there, from element `first` on.
  template <typename T>
  void write(const Buffer& buffer, std::span<const T> values, std::size_t first) {
    if (!values.empty())
      queue_.enqueueWriteBuffer(buffer.handle(), CL_TRUE, first * sizeof(T), values.size_bytes(),
                                values.data());
  }
  template <typename T>
  Buffer upload(const std::vector<T>& values, const std::string& what) {
    Buffer made = buffer(values.size() * sizeof(T), what);
    write(made, values);
    return made;
  }
  template <typename T>
  std::vector<T> read(const Buffer& buffer, std::size_t count) {
    std::vector<T> values(count);
    if (count > 0) queue_.enqueueReadBuffer(buffer.handle(), CL_TRUE, 0, count * sizeof(T), values.data());
    return values;
  }

  /// A read-only 1-D image of a buffer that holds `values`, as floats of one channel: the same for the same values, and
  /// alive as long as the session. `what` names it in errors. For devices with images (Device::images).
  const cl::Image1DBuffer& table_image(const std::vector<float>& values, const std::string& what);

  /// Largest buffer that still fits [bytes]: the device's limit for one, and what is left of its memory.
  std::size_t largest_buffer() const;

  std::size_t device_bytes() const { return use_->now; }        ///< in use
  std::size_t most_device_bytes() const { return use_->most; }  ///< at once, so far
  double build_ms() const { return build_ms_; }  ///< spent compiling, or loading from the cache, so far

 private:
  Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  Timeline timeline_;
  void build(Program& program);
  bool load(Program& program);

  void require_room(std::size_t bytes, const std::string& what) const;

  bool oclgrind() const { return device_.platform == "Oclgrind"; }

  std::optional<ProgramCache> cache_;
  std::map<std::string, std::shared_ptr<Program>> programs_;  ///< by ProgramCache::key
  std::vector<Buffer> kept_;                                  ///< see buffer()
  struct TableImage {
    Buffer values;
    cl::Image1DBuffer image;
  };
  std::map<std::vector<float>, TableImage> table_images_;  ///< see table_image()
  std::shared_ptr<MemoryUse> use_ = std::make_shared<MemoryUse>();
  double build_ms_ = 0;
};

/// Marks a stage for the timeline while it lives.
class StageScope {
 public:
  StageScope(Session& session, StageMark mark) : session_(session) {
    session_.timeline().begin(std::move(mark));
  }
  ~StageScope() noexcept(false) { session_.timeline().end(session_.queue()); }
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  Session& session_;
};

}  // namespace clpv
