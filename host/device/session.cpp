// SPDX-License-Identifier: MIT
#include "device/session.hpp"

#include <algorithm>
#include <utility>

#include "device/cl_error.hpp"
#include "device/kernel.hpp"
#include "device/programs.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

constexpr std::size_t kCopiedBytes = 1 << 20;  // larger writes wait for the queue rather than copy

/// Runs a kernel of buffer_ops.cl on `bytes` bytes of its last buffer, from byte `from` on.
template <typename... Buffers>
void run_on_words(Session& session, const char* kernel, std::size_t bytes, std::size_t from,
                  const Buffers&... buffers) {
  constexpr std::size_t kGroup = 64;
  const cl_uint words = bytes / sizeof(cl_uint), first = from / sizeof(cl_uint);
  Kernel(session, {"buffer_ops.cl"}, kernel).set(buffers..., first, words).launch(words, kGroup);
}

std::size_t round_up(std::size_t value, std::size_t step) {
  return step == 0 ? value : (value + step - 1) / step * step;
}

}  // namespace

Session::Session(Device device, std::optional<ProgramCache> cache, Compilation compilation,
                 bool times)
    : device_(std::move(device)),
      context_(shared_context(device_.handle)),
      queue_(context_, device_.handle,
             times && device_.profiling_valid ? CL_QUEUE_PROFILING_ENABLE : 0),
      timeline_(times && device_.profiling_valid, times),
      zeroed_(compilation.claims.has_value()),
      programs_(device_, context_, std::move(cache), std::move(compilation)) {
  if (times && !device_.profiling_valid)
    log_warning("the device's events have no plausible times: those of stages are the host's");
}

Session::Session(GivenQueue given, std::optional<ProgramCache> cache)
    : device_(std::move(given.device)),
      context_(std::move(given.context)),
      queue_(std::move(given.queue)),
      timeline_(device_.profiling_valid, false),
      programs_(device_, context_, std::move(cache), {}) {}

// After an error, commands may be unfinished. Without this wait PoCL's threads continue to run and
// compile them while the process ends, which crashed 1 of 8 such runs.
Session::~Session() {
  try {
    queue_.finish();
  } catch (const cl::Error& error) {
    log_debug("finishing the queue: {}", cl_error_name(error.err()));
  }
}

void Session::record(const std::filesystem::path& folder) {
  recorder_ = std::make_unique<Recorder>(folder, queue_);
  zeroed_ = true;
  programs_.record(*recorder_);
}

const cl::Image1DBuffer& Session::table_image(const std::vector<float>& values,
                                              const std::string& what) {
  // PoCL 3.1 frees the buffer's memory when the image is released, even if the buffer is still in
  // use. The session therefore keeps every image of a buffer until its end.
  TableImage& table = table_images_[values];
  if (table.image() == nullptr) {
    table.values = upload(values, what);
    // Every device with images reads CL_R, CL_FLOAT (OpenCL 1.2, section 5.3.2.1).
    try {
      table.image = cl::Image1DBuffer(context_, CL_MEM_READ_ONLY, cl::ImageFormat(CL_R, CL_FLOAT),
                                      values.size(), table.values.handle());
    } catch (const cl::Error& error) {
      if (error.err() != CL_INVALID_OPERATION)
        throw cl_error(error, fmt::format("{} on {}", what, device_.name));
      throw Error(ExitCode::device,  // PoCL 7.1
                  "evaluate image: the driver of {} makes no 1-D images of buffers: {} failed with "
                  "{}; allowed: exact, buffer",
                  device_.name, error.what(), cl_error_name(error.err()));
    }
  }
  return table.image;
}

void Session::write_bytes(const Buffer& buffer, std::span<const std::byte> bytes, std::size_t at) {
  if (bytes.empty()) return;
  timeline_.host().written += bytes.size();
  if (bytes.size() > kCopiedBytes) {
    timeline_.wait([&] {
      queue_.enqueueWriteBuffer(buffer.handle(), CL_TRUE, at, bytes.size(), bytes.data());
    });
    return;
  }
  std::erase_if(writes_, [](const Write& write) {
    return write.done.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>() <= CL_COMPLETE;
  });
  Write write{{bytes.begin(), bytes.end()}, {}};
  named_errors([&] {
    queue_.enqueueWriteBuffer(buffer.handle(), CL_FALSE, at, bytes.size(), write.bytes.data(),
                              nullptr, &write.done);
  });
  writes_.push_back(std::move(write));
}

std::shared_ptr<const Session::Arriving> Session::read_later(const Buffer& buffer,
                                                             std::size_t count) {
  std::erase_if(reads_, [](const auto& read) { return read->arrived(); });
  const auto read = std::make_shared<Arriving>(Arriving{std::vector<cl_uint>(count), {}});
  named_errors([&] {
    queue_.enqueueReadBuffer(buffer.handle(), CL_FALSE, 0, count * sizeof(cl_uint),
                             read->values.data(), nullptr, &read->done);
  });
  reads_.push_back(read);
  return read;
}

void Session::launch(const cl::Kernel& kernel, const cl::NDRange& global, const cl::NDRange& local,
                     Chain chain) {
  const std::size_t* g = global.get();
  const std::size_t* l = local.get();
  cl::NDRange rounded = global;
  if (global.dimensions() == 1) rounded = cl::NDRange(round_up(g[0], l[0]));
  if (global.dimensions() == 2) rounded = cl::NDRange(round_up(g[0], l[0]), round_up(g[1], l[1]));
  if (global.dimensions() == 3) {
    rounded = cl::NDRange(round_up(g[0], l[0]), round_up(g[1], l[1]), round_up(g[2], l[2]));
  }
  std::size_t group = 1;
  for (std::size_t i = 0; i < local.dimensions(); ++i) group *= l[i];
  if (const std::size_t most = kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device_.handle);
      group > most)
    throw Error(ExitCode::device, "kernel '{}' on {}: found work-groups of at most {}; allowed: {}",
                kernel.getInfo<CL_KERNEL_FUNCTION_NAME>(), device_.name, most, group);
  if (recorder_) recorder_->begin_launch(kernel, rounded, local);
  std::size_t items = 1;
  for (std::size_t i = 0; i < rounded.dimensions(); ++i) items *= rounded.get()[i];
  try {
    timeline_.enqueue(
        [&](cl::Event* event) {
          queue_.enqueueNDRangeKernel(kernel, cl::NullRange, rounded, local, nullptr, event);
        },
        kernel, items, chain);
  } catch (const cl::Error& error) {
    throw cl_error(error, fmt::format("kernel '{}' on {}",
                                      kernel.getInfo<CL_KERNEL_FUNCTION_NAME>(), device_.name));
  }
  if (recorder_) recorder_->end_launch();
}

// Oclgrind 21.10's memory checker does not count a fill as initialisation. After a write or copy to
// a part of a buffer it also loses track of the rest. Either would make it report valid reads, so
// kernels fill and copy there.
void Session::fill_zero(const Buffer& buffer, std::size_t bytes, std::size_t from) {
  if (device_.oclgrind()) return run_on_words(*this, "zero", bytes, from, buffer);
  // A pattern of 1 byte makes PoCL call memset: 5x faster than 4-byte patterns or a kernel.
  timeline_.enqueue([&](cl::Event* event) {
    named_errors([&] {
      queue_.enqueueFillBuffer(buffer.handle(), cl_uchar{0}, from, bytes, nullptr, event);
    });
  });
}

void Session::copy(const Buffer& from, const Buffer& to, std::size_t bytes, std::size_t to_byte) {
  if (device_.oclgrind()) return run_on_words(*this, "copy", bytes, to_byte, from, to);
  timeline_.enqueue([&](cl::Event* event) {
    named_errors([&] {
      queue_.enqueueCopyBuffer(from.handle(), to.handle(), 0, to_byte, bytes, nullptr, event);
    });
  });
}

}  // namespace clpv
