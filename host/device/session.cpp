// SPDX-License-Identifier: MIT
#include "device/session.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "device/cl_error.hpp"
#include "device/kernel.hpp"
#include "device/shared_programs.hpp"
#include "support/fingerprint.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"

namespace clpv {
namespace {

ProgramSource words_program() {
  return {"buffer_ops.cl"};
}
constexpr std::size_t kWordsGroup = 64;
constexpr double kNoticeMs = 2000;             // longer waits are explained in the log
constexpr std::size_t kCopiedBytes = 1 << 20;  // larger writes wait for the queue rather than copy

cl_uint words_of(std::size_t bytes) {
  return bytes / sizeof(cl_uint);
}

std::size_t round_up(std::size_t value, std::size_t step) {
  return step == 0 ? value : (value + step - 1) / step * step;
}

double mib(std::size_t bytes) {
  return static_cast<double>(bytes) / (1 << 20);
}

/// Builds a program from a cached binary; returns nothing if the driver rejects it.
std::optional<cl::Program> load_program(const cl::Context& context, const Device& device,
                                        const std::string& options,
                                        const ProgramCache::Binary& binary) {
  try {
    cl::Program program(context, {device.handle}, {binary});
    program.build(device.handle, options.c_str());
    return program;
  } catch (const cl::Error& error) {
    log_debug("{} rejects a cached program: {}; compiling it again", device.name,
              cl_error_name(error.err()));
    return std::nullopt;
  }
}

/// Name of the file that a helper writes when it has compiled a kernel of the program with that
/// key.
std::string name_of_claim(const std::string& key, const std::string& kernel) {
  return fmt::format("{}.{}", Fingerprint().add(key).hex(), kernel);
}

/// Writes a program's text to the folder CLPV_PROGRAM_DUMP, for other compilers and for bug
/// reports.
void dump(const ProgramSource& source, const std::string& text) {
  const char* folder = std::getenv("CLPV_PROGRAM_DUMP");
  if (folder == nullptr || *folder == '\0') return;
  const std::string name = std::filesystem::path(source.file).filename().string();
  const std::filesystem::path file =
      std::filesystem::path(folder) / fmt::format("{}.{}", Fingerprint().add(text).hex(), name);
  try {
    write_file(file, text);
  } catch (const Error& error) {
    throw Error(ExitCode::run_time, "CLPV_PROGRAM_DUMP: {}", error.what());
  }
}

}  // namespace

Session::Session(Device device, std::optional<ProgramCache> cache, Compilation compilation)
    : device_(std::move(device)),
      context_(shared_context(device_.handle)),
      queue_(context_, device_.handle, device_.profiling_valid ? CL_QUEUE_PROFILING_ENABLE : 0),
      timeline_(device_.profiling_valid),
      cache_(std::move(cache)),
      compilation_(std::move(compilation)),
      marks_(device_) {}

Session::Session(GivenQueue given, std::optional<ProgramCache> cache)
    : device_(std::move(given.device)),
      context_(std::move(given.context)),
      queue_(std::move(given.queue)),
      timeline_(device_.profiling_valid, false),
      cache_(std::move(cache)),
      marks_(device_) {}

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
}

std::shared_ptr<Program> Session::describe(const ProgramSource& source) {
  ProgramSource specialised = source;
  if (!source.literals.defined().contains("CLPV_W"))
    specialised.literals.integer("CLPV_W", device_.lanes);
  std::string text = program_text(specialised);
  std::string key = ProgramCache::key(device_, source.options, text);
  std::shared_ptr<Program>& program = programs_[key];
  if (!program)
    program = std::make_shared<Program>(
        Program{std::move(specialised), std::move(text), std::move(key), {}});
  return program;
}

void Session::build_described() {
  // Programs without another owner belong to stages that no longer exist.
  std::erase_if(programs_, [](const auto& entry) {
    return entry.second->built() == nullptr && entry.second.use_count() == 1;
  });
  compiling_ms_ = 0;
  if (compilation_.claims) return;  // a helper builds what it launches
  compile_with_helpers();
  for (auto& [key, program] : programs_) build(*program);
}

/// Lets helpers compile all kernels that this session will launch, if the driver's cache has not
/// got them.
void Session::compile_with_helpers() {
  if (compilation_.helpers.empty() || helper_count() == 0 || !marks_.available()) return;
  std::size_t programs = 0, kernels = 0;
  for (const auto& [key, program] : programs_) {
    if (program->built() != nullptr || marks_.has(key)) continue;
    ++programs;
    kernels += program->kernels.size();
  }
  if (programs < 2) return;
  log_info("compiling {} kernels for {}: on the first run only", kernels, device_.name);
  const auto start = std::chrono::steady_clock::now();
  Progress progress("compiling kernels", kernels);
  helped_ = true;
  const std::unique_ptr<Helpers> helpers = started_helpers();
  if (!helpers) return;
  while (helpers->wait()) {
    stop_if_interrupted("kernels were being compiled");
    build_one_compiled(helpers->claims());
    // Some are described later.
    progress.reach(std::min(helpers->claims().finished_count(), kernels));
  }
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  log_debug("{} helpers compiled {} kernels in {:.1f} s", helper_count(),
            helpers->claims().finished_count(), elapsed.count());
  if (!helpers->failures().empty())
    log_debug("a helper failed, so this process compiles the rest: {}", helpers->failures());
}

/// Null, with a warning, where no folder can be made for the helpers: a frame needs none.
std::unique_ptr<Helpers> Session::started_helpers() const {
  try {
    return std::make_unique<Helpers>(compilation_.helpers);
  } catch (const Error& error) {
    log_warning("{}: this process compiles all kernels itself", error.what());
    return nullptr;
  }
}

/// Builds a program whose kernels helpers have compiled, from the driver's cache, while they
/// compile others.
void Session::build_one_compiled(const Claims& claims) {
  for (const auto& entry : programs_) {
    Program& program = *entry.second;
    if (program.built() != nullptr || program.kernels.empty()) continue;
    const bool compiled = std::ranges::all_of(program.kernels, [&](const std::string& kernel) {
      return claims.finished(name_of_claim(program.key, kernel));
    });
    if (compiled) return build(program);
  }
}

bool Session::claims(Program& program) {
  if (!compilation_.claims) return true;
  if (!program.claimed)
    program.claimed =
        !marks_.has(program.key) && compilation_.claims->take(Fingerprint().add(program.key).hex());
  return *program.claimed;
}

void Session::finish_first_launch(Program& program, const std::string& name) {
  if (!program.launched.insert(name).second) return;
  const auto start = std::chrono::steady_clock::now();
  const Uninterruptible compiling("this kernel");
  timeline_.wait([&] { queue_.finish(); });
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  log_debug("kernels/{}: first launch of {} in {:.1f} ms", program.source.file, name,
            elapsed.count());
  if (compilation_.claims) {
    compilation_.claims->finish(name_of_claim(program.key, name));
  } else if (marks_.available() && !marks_.has(program.key)) {
    note_compiling(program, elapsed.count());
    if (std::ranges::includes(program.launched, program.kernels)) marks_.add(program.key);
  }
  stop_if_interrupted("kernels were being compiled");
}

void Session::mark_compiled() {
  for (const auto& [key, program] : programs_) {
    if (!claims(*program)) continue;
    build(*program);  // this frame launched none of its kernels, or it is built already
    marks_.add(key);
  }
}

cl::Kernel Session::kernel(Program& program, const std::string& name) {
  build(program);
  return cl::Kernel(program.built, name.c_str());
}

void Session::build(Program& program) {
  if (program.built() != nullptr) return;
  stop_if_interrupted("kernels were being compiled");
  dump(program.source, program.text);
  const Uninterruptible compiling("this kernel");
  const auto start = std::chrono::steady_clock::now();
  if (recorder_) recorder_->add_program(program.source.file, program.source.options, program.text);
  program.stored = load(program);
  const bool alone = cache_ || compilation_.claims;  // what they store and claim is built by them
  if (!program.stored && !alone) program.built = shared_program(context_, program.key);
  const bool built_before = program.built() != nullptr;
  if (!built_before) {
    program.built = build_program(context_, device_, program.source, program.text);
    if (!alone) share_program(context_, program.key, program.built);
  }
  if (recorder_) recorder_->built(program.built);
  const std::chrono::duration<double, std::milli> elapsed =
      std::chrono::steady_clock::now() - start;
  build_ms_ += elapsed.count();
  if (!built_before && !marks_.has(program.key)) note_compiling(program, elapsed.count());
  log_debug("kernels/{}: {} in {:.1f} ms", program.source.file,
            program.stored ? "from the cache"
            : built_before ? "of an earlier session"
                           : "compiled",
            elapsed.count());
}

/// Explains a long wait for kernels that no earlier run compiled, once for each build_described().
void Session::note_compiling(const Program& program, double ms) {
  const double before_ms = std::exchange(compiling_ms_, compiling_ms_ + ms);
  if (helped_ || before_ms > kNoticeMs || compiling_ms_ <= kNoticeMs) return;
  log_info("compiling kernels for {}: {:.1f} s so far, now {}; once for these options and sizes",
           device_.name, compiling_ms_ / 1000, program.source.file);
}

/// Loads a program from the cache; returns false if it is missing or the driver rejects it.
bool Session::load(Program& program) {
  if (!cache_) return false;
  const auto binary = cache_->load(program.key);
  if (!binary) return false;
  if (const auto loaded = load_program(context_, device_, program.source.options, *binary)) {
    program.built = *loaded;
    return true;
  }
  cache_->remove(program.key);
  return false;
}

void Session::store_programs() {
  if (!cache_) return;
  bool logged = false;
  for (auto& [key, program] : programs_) {
    if (program->stored || program->built() == nullptr) continue;
    // Reading a binary makes some drivers compile again.
    if (!std::exchange(logged, true) && build_ms_ > kNoticeMs)
      log_info("caching the compiled kernels for later runs");
    const auto binaries = program->built.getInfo<CL_PROGRAM_BINARIES>();
    // A caller's context may have several.
    const auto devices = program->built.getInfo<CL_PROGRAM_DEVICES>();
    const std::size_t ours =
        std::ranges::find(devices, device_.handle(), [](const auto& d) { return d(); }) -
        devices.begin();
    if (ours >= binaries.size() || binaries[ours].empty()) {
      log_debug("{} returns no program binaries to cache", device_.name);
      return;
    }
    if (!cache_->store(key, binaries[ours]))
      return;  // it logged why; the next program would fail too
    program->stored = true;
  }
}

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
    if (compilation_.claims || recorder_)
      queue_.enqueueFillBuffer(made.handle(), cl_uchar{0}, 0, bytes);
    // Oclgrind 21.10's memory checker confuses a new buffer at a freed address with the old one and
    // its size.
    if (oclgrind()) retained_.push_back(made);
    return made;
  } catch (const cl::Error& error) {
    throw cl_error(error, fmt::format("{} ({:.1f} MiB) on {}", what, mib(bytes), device_.name));
  }
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
  queue_.enqueueWriteBuffer(buffer.handle(), CL_FALSE, at, bytes.size(), write.bytes.data(),
                            nullptr, &write.done);
  writes_.push_back(std::move(write));
}

std::shared_ptr<const Session::Arriving> Session::read_later(const Buffer& buffer,
                                                             std::size_t count) {
  std::erase_if(reads_, [](const auto& read) { return read->arrived(); });
  const auto read = std::make_shared<Arriving>(Arriving{std::vector<cl_uint>(count), {}});
  queue_.enqueueReadBuffer(buffer.handle(), CL_FALSE, 0, count * sizeof(cl_uint),
                           read->values.data(), nullptr, &read->done);
  reads_.push_back(read);
  return read;
}

void Session::launch(const cl::Kernel& kernel, const cl::NDRange& global,
                     const cl::NDRange& local) {
  const std::size_t* g = global.get();
  const std::size_t* l = local.get();
  cl::NDRange rounded = global;
  if (global.dimensions() == 1) rounded = cl::NDRange(round_up(g[0], l[0]));
  if (global.dimensions() == 2) rounded = cl::NDRange(round_up(g[0], l[0]), round_up(g[1], l[1]));
  if (global.dimensions() == 3) {
    rounded = cl::NDRange(round_up(g[0], l[0]), round_up(g[1], l[1]), round_up(g[2], l[2]));
  }
  if (recorder_) recorder_->begin_launch(kernel, rounded, local);
  cl::Event event;
  try {
    queue_.enqueueNDRangeKernel(kernel, cl::NullRange, rounded, local, nullptr, &event);
  } catch (const cl::Error& error) {
    throw cl_error(error, fmt::format("kernel '{}' on {}",
                                      kernel.getInfo<CL_KERNEL_FUNCTION_NAME>(), device_.name));
  }
  if (recorder_) recorder_->end_launch();
  timeline_.add(event);
}

// Oclgrind 21.10's memory checker does not count a fill as initialisation. After a write or copy to
// a part of a buffer it also loses track of the rest. Either would make it report valid reads, so
// kernels fill and copy there.
void Session::fill_zero(const Buffer& buffer, std::size_t bytes, std::size_t from) {
  if (oclgrind()) {
    const cl_uint words = words_of(bytes), first = words_of(from);
    Kernel(*this, words_program(), "zero")
        .set(buffer, first, words)
        .launch(cl::NDRange(words), cl::NDRange(kWordsGroup));
    return;
  }
  cl::Event event;
  // A pattern of 1 byte makes PoCL call memset: 5x faster than 4-byte patterns or a kernel.
  queue_.enqueueFillBuffer(buffer.handle(), cl_uchar{0}, from, bytes, nullptr, &event);
  timeline_.add(event);
}

void Session::copy(const Buffer& from, const Buffer& to, std::size_t bytes, std::size_t to_byte) {
  if (oclgrind()) {
    const cl_uint words = words_of(bytes), first = words_of(to_byte);
    Kernel(*this, words_program(), "copy")
        .set(from, to, first, words)
        .launch(cl::NDRange(words), cl::NDRange(kWordsGroup));
    return;
  }
  cl::Event event;
  queue_.enqueueCopyBuffer(from.handle(), to.handle(), 0, to_byte, bytes, nullptr, &event);
  timeline_.add(event);
}

}  // namespace clpv
