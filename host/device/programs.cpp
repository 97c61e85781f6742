// SPDX-License-Identifier: MIT
#include "device/programs.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <map>
#include <mutex>
#include <utility>

#include "device/cl_error.hpp"
#include "device/recorder.hpp"
#include "support/fingerprint.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"
#include "support/progress.hpp"

namespace clpv {
namespace {

constexpr std::size_t kKept = 256;  // programs of about ten sets of options

/// Contexts and programs of the process.
struct SharedPrograms {
  struct Kept {
    cl::Program built;
    std::size_t used = 0;
  };
  std::mutex mutex;
  std::map<cl_device_id, cl::Context> contexts;
  std::map<std::pair<cl_context, std::string>, Kept> programs;
  std::size_t uses = 0;
};

/// Never released: a driver's own statics may be gone before those of this library.
SharedPrograms& shared_programs() {
  static auto* const all = new SharedPrograms;
  return *all;
}

constexpr double kNoticeMs = 2000;  // longer waits are explained in the log

/// Writes a program's text to the folder CLPV_PROGRAM_DUMP, for other compilers and for bug
/// reports.
void dump(const ProgramSource& source, const std::string& text) {
  const char* folder = std::getenv("CLPV_PROGRAM_DUMP");
  if (folder == nullptr || *folder == '\0') return;
  const std::string name = std::filesystem::path(source.file).filename().string();
  const std::filesystem::path file =
      std::filesystem::path(folder) / fmt::format("{}.{}", Fingerprint().add(text).hex(), name);
  try {
    write_file(file, text, OutputFile::Kind::derived);
  } catch (const Error& error) {
    throw Error(ExitCode::run_time, "CLPV_PROGRAM_DUMP: {}", error.what());
  }
}

}  // namespace

cl::Context shared_context(const cl::Device& device) {
  SharedPrograms& shared = shared_programs();
  const std::scoped_lock lock(shared.mutex);
  cl::Context& context = shared.contexts[device()];
  if (context() == nullptr) context = cl::Context(device);
  return context;
}

cl::Program shared_program(const cl::Context& context, const std::string& key) {
  SharedPrograms& shared = shared_programs();
  const std::scoped_lock lock(shared.mutex);
  const auto found = shared.programs.find({context(), key});
  if (found == shared.programs.end()) return {};
  found->second.used = ++shared.uses;
  return found->second.built;
}

void share_program(const cl::Context& context, const std::string& key, const cl::Program& built) {
  SharedPrograms& shared = shared_programs();
  const std::scoped_lock lock(shared.mutex);
  const auto has = [&](const auto& entry) { return entry.second() == context(); };
  if (std::ranges::none_of(shared.contexts, has)) return;
  shared.programs[{context(), key}] = {built, ++shared.uses};
  if (shared.programs.size() <= kKept) return;
  shared.programs.erase(std::ranges::min_element(
      shared.programs, {}, [](const auto& entry) { return entry.second.used; }));
}

Programs::Programs(const Device& device, const cl::Context& context,
                   std::optional<ProgramCache> cache, Compilation compilation)
    : device_(device),
      context_(context),
      cache_(std::move(cache)),
      compilation_(std::move(compilation)),
      marks_(device) {}

std::shared_ptr<Program> Programs::describe(const ProgramSource& source) {
  ProgramSource specialised = source;
  if (!source.literals.defined().contains("CLPV_W"))
    specialised.literals.integer("CLPV_W", device_.lanes);
  std::string text = program_text(specialised);
  std::string key = ProgramCache::key(device_, source.options, text);
  std::shared_ptr<Program>& program = programs_[key];
  if (!program) {
    const std::string hash = Fingerprint().add(key).hex();
    program = std::make_shared<Program>(
        Program{std::move(specialised), std::move(text), std::move(key), hash, {}});
  }
  return program;
}

void Programs::build_described() {
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
void Programs::compile_with_helpers() {
  if (compilation_.helpers.empty() || helper_count() == 0 || !marks_.available()) return;
  std::size_t programs = 0, kernels = 0;
  for (const auto& [key, program] : programs_) {
    if (program->built() != nullptr || marks_.has(program->hash)) continue;
    ++programs;
    kernels += program->kernels.size();
  }
  if (programs < 2) return;
  log_info("compiling {} kernels for {}, whose cache lacks those of this size and scene", kernels,
           device_.name);
  const auto start = std::chrono::steady_clock::now();
  Progress progress("compiling kernels", kernels);
  helped_ = true;
  std::optional<Helpers> helpers;
  try {
    helpers.emplace(compilation_.helpers);
  } catch (const Error& error) {  // no folder for them
    return log_warning("{}: this process compiles all kernels itself", error.what());
  }
  while (helpers->wait()) {
    stop_if_interrupted("kernels were being compiled");
    // Some are described later.
    progress.reach(std::min(helpers->claims().finished_count(), kernels));
  }
  log_debug("{} helpers compiled {} kernels in {:.1f} s", helper_count(),
            helpers->claims().finished_count(), ms_since(start) / 1000);
  if (!helpers->failures().empty())
    log_debug("a helper failed, so this process compiles the rest: {}", helpers->failures());
}

bool Programs::claims(Program& program) {
  if (!compilation_.claims) return true;
  if (!program.claimed)
    program.claimed = !marks_.has(program.hash) && compilation_.claims->take(program.hash);
  return *program.claimed;
}

void Programs::finish_first_launch(Program& program, const std::string& name,
                                   const std::function<void()>& finish) {
  if (!program.launched.insert(name).second) return;
  const auto start = std::chrono::steady_clock::now();
  const Uninterruptible compiling("this kernel");
  finish();
  const double ms = ms_since(start);
  log_debug("kernels/{}: first launch of {} in {:.1f} ms", program.source.file, name, ms);
  if (compilation_.claims) {
    compilation_.claims->finish(fmt::format("{}.{}", program.hash, name));
  } else if (marks_.available() && !marks_.has(program.hash)) {
    note_compiling(program, ms);
    if (std::ranges::includes(program.launched, program.kernels)) marks_.add(program.hash);
  }
  stop_if_interrupted("kernels were being compiled");
}

void Programs::mark_compiled() {
  for (const auto& [key, program] : programs_) {
    if (!claims(*program)) continue;
    build(*program);  // this frame launched none of its kernels, or it is built already
    marks_.add(program->hash);
  }
}

cl::Kernel Programs::kernel(Program& program, const std::string& name) {
  build(program);
  return {program.built, name.c_str()};
}

void Programs::build(Program& program) {
  if (program.built() != nullptr) return;
  stop_if_interrupted("kernels were being compiled");
  dump(program.source, program.text);
  const Uninterruptible compiling("this kernel");
  const auto start = std::chrono::steady_clock::now();
  if (recorder_) recorder_->add_program(program.source.file, program.source.options, program.text);
  program.stored = load(program);
  const bool alone = cache_ || compilation_.claims;  // they build their programs themselves
  if (!program.stored && !alone) program.built = shared_program(context_, program.key);
  const bool built_before = program.built() != nullptr;
  if (!built_before) {
    program.built = build_program(context_, device_, program.source, program.text);
    if (!alone) share_program(context_, program.key, program.built);
  }
  if (recorder_) recorder_->built(program.built);
  const double ms = ms_since(start);
  build_ms_ += ms;
  if (!built_before && !marks_.has(program.hash)) note_compiling(program, ms);
  log_debug("kernels/{}: {} in {:.1f} ms", program.source.file,
            program.stored ? "from the cache"
            : built_before ? "of an earlier session"
                           : "compiled",
            ms);
}

/// Explains a long wait for kernels that no earlier run compiled, once for each build_described().
void Programs::note_compiling(const Program& program, double ms) {
  const double before_ms = std::exchange(compiling_ms_, compiling_ms_ + ms);
  if (helped_ || before_ms > kNoticeMs || compiling_ms_ <= kNoticeMs) return;
  log_info("compiling kernels for {}: {:.1f} s so far, now {}; once for these options and sizes",
           device_.name, compiling_ms_ / 1000, program.source.file);
}

/// Loads a program from the cache; returns false if it is missing or the driver rejects it.
bool Programs::load(Program& program) {
  const auto binary = cache_ ? cache_->load(program.key) : std::nullopt;
  if (!binary) return false;
  try {
    cl::Program loaded(context_, {device_.handle}, {*binary});
    loaded.build(device_.handle, program.source.options.c_str());
    program.built = loaded;
    return true;
  } catch (const cl::Error& error) {
    log_debug("{} rejects a cached program: {}; compiling it again", device_.name,
              cl_error_name(error.err()));
    cache_->remove(program.key);
    return false;
  }
}

void Programs::store() {
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

}  // namespace clpv
