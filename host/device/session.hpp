// A device in use: context, in-order queue, programs built so far, memory held and times taken.
#pragma once

#include <CL/opencl.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "device/program.hpp"
#include "device/program_cache.hpp"
#include "device/timeline.hpp"

namespace clpv {

/// One device opened for work. Everything is enqueued on one in-order queue. Not thread safe; one a thread.
class Session {
 public:
  /// `cache`: where compiled programs are looked for, and where store_programs() keeps them; none: always
  /// compiled.
  explicit Session(Device device, std::optional<ProgramCache> cache = std::nullopt);

  const Device& device() const { return device_; }
  cl::Context& context() { return context_; }
  cl::CommandQueue& queue() { return queue_; }
  Timeline& timeline() { return timeline_; }

  /// The kernel `name` of a program, built at the first use of this very source.
  /// Throws Error(run_time) with the compiler's log and the numbered lines round the fault.
  cl::Kernel kernel(const ProgramSource& source, const std::string& name);

  /// Keeps the programs compiled so far in the cache. To be called last, when results are out: PoCL's
  /// binaries hold the code for the work-group sizes launched until then, and making one costs about as long
  /// as the first launches.
  void store_programs();

  /// A buffer of `bytes` (at least 4), its contents undefined; zeroed by fill_zero(). `what` names it in errors.
  /// Throws Error(run_time) before allocating where the device cannot hold it, and says what it could.
  cl::Buffer buffer(std::size_t bytes, const std::string& what, cl_mem_flags flags = CL_MEM_READ_WRITE);
  void account(std::size_t bytes) { bytes_ += bytes; }  ///< for memory taken outside buffer()

  /// Runs `kernel` over at least `global` work-items, rounded up to whole groups of `local` in each dimension
  /// (non-uniform groups do not exist in OpenCL 1.2; kernels guard their range). Timed under the current
  /// mark.
  void launch(const cl::Kernel& kernel, const cl::NDRange& global, const cl::NDRange& local);
  void fill_zero(const cl::Buffer& buffer, std::size_t bytes);  ///< the first `bytes`, a multiple of 4
  void copy(const cl::Buffer& from, const cl::Buffer& to, std::size_t bytes);

  template <typename T>
  void write(const cl::Buffer& buffer, const std::vector<T>& values) {
    if (!values.empty())
      queue_.enqueueWriteBuffer(buffer, CL_TRUE, 0, values.size() * sizeof(T), values.data());
  }
  template <typename T>
  cl::Buffer upload(const std::vector<T>& values, const std::string& what) {
    cl::Buffer made = buffer(values.size() * sizeof(T), what);
    write(made, values);
    return made;
  }
  template <typename T>
  std::vector<T> read(const cl::Buffer& buffer, std::size_t count) {
    std::vector<T> values(count);
    if (count > 0) queue_.enqueueReadBuffer(buffer, CL_TRUE, 0, count * sizeof(T), values.data());
    return values;
  }

  /// A read-only 1-D image of a buffer that holds `values`, as floats of one channel: the same for the same values, and
  /// alive as long as the session. `what` names it in errors. For devices with images (Device::images).
  const cl::Image1DBuffer& table_image(const std::vector<float>& values, const std::string& what);

  /// Largest buffer that still fits [bytes]: the device's limit for one, and what is left of its memory.
  std::size_t largest_buffer() const;

  std::size_t device_bytes() const { return bytes_; }  ///< allocated so far
  double build_ms() const { return build_ms_; }        ///< spent compiling, or loading from the cache, so far

 private:
  Device device_;
  cl::Context context_;
  cl::CommandQueue queue_;
  Timeline timeline_;
  struct Built {
    cl::Program program;
    bool stored = false;  ///< in the cache: came from there, or was put there
  };
  cl::Program build(const ProgramSource& source, const std::string& text, const std::string& key,
                    bool& stored);

  void fill_by_kernel(const cl::Buffer& buffer, std::size_t bytes);

  bool oclgrind() const { return device_.platform == "Oclgrind"; }

  std::optional<ProgramCache> cache_;
  std::map<std::string, Built> programs_;                         ///< by ProgramCache::key
  std::vector<cl::Buffer> kept_;                                  ///< see buffer()
  std::map<std::vector<float>, cl::Image1DBuffer> table_images_;  ///< see table_image()
  std::size_t bytes_ = 0;
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
