// SPDX-License-Identifier: MIT
// A session on one device: context, in-order queue, programs, memory use and stage times.
#pragma once

#include <CL/opencl.hpp>
#include <array>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "device/driver_cache.hpp"
#include "device/given_queue.hpp"
#include "device/memory.hpp"
#include "device/program.hpp"
#include "device/program_cache.hpp"
#include "device/recorder.hpp"
#include "device/timeline.hpp"
#include "support/error.hpp"
#include "support/helpers.hpp"

namespace clpv {

/// A program of a session: described first, built on first use.
struct Program {
  ProgramSource source;
  std::string text, key;                ///< program_text(source), ProgramCache::key
  cl::Program built;                    ///< null until built
  bool stored = false;                  ///< true if the cache has it
  std::set<std::string> kernels = {};   ///< names of the kernels described so far
  std::set<std::string> launched = {};  ///< names of the kernels launched so far
  std::optional<bool> claimed = {};     ///< in a helper: true if it compiles this program
};

/// Who compiles a session's kernels.
struct Compilation {
  /// Arguments of clpv for helper processes that do what this session is about to do. Empty: the
  /// session itself compiles.
  std::vector<std::string> helpers;
  /// In such a helper: claims of programs. The session builds and launches only the kernels of
  /// programs that it claims, and all its buffers start with zeros.
  std::optional<Claims> claims;
};

/// More memory or numbers than the device allows.
class TooLarge : public Error {
 public:
  TooLarge(Error error, double share) : Error(std::move(error)), share(share) {}
  double share;  ///< what the device allows over what the session has and needs; less than 1
};

/// One open device. All commands go to one in-order queue. Not thread safe: use one session per
/// thread.
class Session {
 public:
  /// `cache`: source of compiled programs and target of store_programs(). Without one every program
  /// is compiled.
  explicit Session(Device device, std::optional<ProgramCache> cache = std::nullopt,
                   Compilation compilation = {});
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

  /// Returns the program of this source, with Device::lanes as CLPV_W unless it says another.
  /// build_described() or the first kernel() of it builds it, once per session.
  std::shared_ptr<Program> describe(const ProgramSource& source);

  /// Builds all described programs that have an owner and are not built yet, with helpers if they
  /// are many. Throws Error(run_time) with the compiler's log, as does kernel(). Throws Interrupted
  /// after a signal.
  void build_described();

  /// Returns the kernel `name` of a program of describe(), which it builds if needed.
  cl::Kernel kernel(Program& program, const std::string& name);

  /// In a helper: returns true if it builds and launches this program's kernels. Elsewhere always
  /// true.
  bool claims(Program& program);

  /// Waits for the first launch of a kernel, which compiles it on some drivers, so that a signal
  /// can end the process there. Logs (debug) the time.
  void finish_first_launch(Program& program, const std::string& name);

  /// In a helper: marks the claimed programs as compiled, after the frame. First builds those whose
  /// kernels it did not launch.
  void mark_compiled();

  /// Stores compiled programs in the cache. Call it last, after results are written: some drivers
  /// compile again when a binary is read.
  void store_programs();

  /// Allocates a buffer of max(bytes, 4) bytes with undefined contents. `what` names it in errors.
  /// Throws Error(run_time), before allocating, if the device's memory does not suffice; it states
  /// the limit.
  Buffer buffer(std::size_t bytes, const std::string& what);
  /// A caller's buffer, whose memory does not count as the session's. Throws as given_buffer().
  Buffer given(cl_mem memory, std::size_t bytes, const char* what) const {
    return {given_buffer(context_, memory, bytes, what), std::make_shared<MemoryShare>(use_, 0)};
  }
  /// Replaces `buffer` by a new one with undefined contents if it has fewer than `bytes` bytes.
  void reserve(Buffer& buffer, std::size_t bytes, const std::string& what);
  /// Allocates an image of `extent` texels and `bytes` bytes with undefined contents. Throws like
  /// buffer().
  Image3D image(const cl::ImageFormat& texel, const std::array<std::size_t, 3>& extent,
                std::size_t bytes, const std::string& what);

  /// Runs `kernel` over `global` work-items, rounded up to whole work-groups of `local` in each
  /// dimension (OpenCL 1.2 has no non-uniform work-groups; kernels guard their range). Timed under
  /// the current stage.
  void launch(const cl::Kernel& kernel, const cl::NDRange& global, const cl::NDRange& local);
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
  std::vector<T> read(const Buffer& buffer, std::size_t count) {
    std::vector<T> values(count);
    if (count == 0) return values;
    timeline_.wait([&] {
      queue_.enqueueReadBuffer(buffer.handle(), CL_TRUE, 0, count * sizeof(T), values.data());
    });
    return values;
  }

  /// Numbers on their way from the device.
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
  /// Time spent compiling programs or loading them [ms].
  double build_ms() const { return build_ms_; }

 private:
  Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  Timeline timeline_;
  void build(Program& program);
  bool load(Program& program);
  void note_compiling(const Program& program, double ms);
  void compile_with_helpers();
  std::unique_ptr<Helpers> started_helpers() const;
  void build_one_compiled(const Claims& claims);

  void write_bytes(const Buffer& buffer, std::span<const std::byte> bytes, std::size_t at);
  void require_room(std::size_t bytes, const std::string& what) const;

  bool oclgrind() const { return device_.platform == "Oclgrind"; }

  std::optional<ProgramCache> cache_;
  Compilation compilation_;
  std::unique_ptr<Recorder> recorder_;
  CompiledMarks marks_;
  bool helped_ = false;                                       ///< helpers compiled
  std::map<std::string, std::shared_ptr<Program>> programs_;  ///< by ProgramCache::key
  struct Write {                                              ///< bytes on their way to the device
    std::vector<std::byte> bytes;
    cl::Event done;
  };
  std::vector<Write> writes_;
  std::vector<std::shared_ptr<Arriving>> reads_;  ///< of read_later(), until they have arrived
  std::vector<Buffer> retained_;                  ///< for Oclgrind, see buffer()
  struct TableImage {
    Buffer values;
    cl::Image1DBuffer image;
  };
  std::map<std::vector<float>, TableImage> table_images_;  ///< see table_image()
  std::shared_ptr<MemoryUse> use_ = std::make_shared<MemoryUse>();
  double build_ms_ = 0;
  double compiling_ms_ = 0;  ///< since build_described(), without kernels that are marked
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
