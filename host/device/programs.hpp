// SPDX-License-Identifier: MIT
// Programs of a session: described, compiled by this process or by helpers, cached.
#pragma once

#include <CL/opencl.hpp>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "device/device.hpp"
#include "device/driver_cache.hpp"
#include "device/program.hpp"
#include "device/program_cache.hpp"
#include "support/helpers.hpp"

namespace clpv {

class Recorder;

/// A program of a session: described first, built on first use.
struct Program {
  ProgramSource source;
  std::string text, key;                ///< program_text(source), ProgramCache::key
  std::string hash;                     ///< of the key: name of its mark and its claim
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

/// Programs for one device and context.
class Programs {
 public:
  /// As Session(). `device` and `context` must outlive this object.
  Programs(const Device& device, const cl::Context& context, std::optional<ProgramCache> cache,
           Compilation compilation);

  /// Adds all programs that are built later to a recording.
  void record(Recorder& recorder) { recorder_ = &recorder; }

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

  /// After a kernel's first launch, which on some drivers compiles it, calls `finish` to wait for
  /// the queue. There a signal can end the process. Logs (debug) the time.
  void finish_first_launch(Program& program, const std::string& name,
                           const std::function<void()>& finish);

  /// In a helper: marks the claimed programs as compiled, after the frame. First builds those whose
  /// kernels it did not launch.
  void mark_compiled();

  /// Stores compiled programs in the cache. Call it last, after results are written: some drivers
  /// compile again when a binary is read.
  void store();

  /// Time spent compiling programs or loading them [ms].
  double build_ms() const { return build_ms_; }

 private:
  void build(Program& program);
  bool load(Program& program);
  void note_compiling(const Program& program, double ms);
  void compile_with_helpers();

  const Device& device_;
  const cl::Context& context_;
  std::optional<ProgramCache> cache_;
  Compilation compilation_;
  Recorder* recorder_ = nullptr;  ///< null: nothing records
  CompiledMarks marks_;
  bool helped_ = false;                                       ///< helpers compiled
  std::map<std::string, std::shared_ptr<Program>> programs_;  ///< by ProgramCache::key
  double build_ms_ = 0;
  double compiling_ms_ = 0;  ///< since build_described(), without kernels that are marked
};

// Sessions of one process share a context for each device, and the programs built in it. With
// PoCL 3.1, a program that its own cache holds still takes 20 to 40 ms to build, and a frame has up
// to 40.

/// Returns the context of a device, which lives as long as the process.
cl::Context shared_context(const cl::Device& device);

/// Returns the program of that ProgramCache::key in a context of shared_context(); null if none was
/// built, if many others were used since, or in any other context. Thread safe.
cl::Program shared_program(const cl::Context& context, const std::string& key);

/// Keeps a built program for later sessions, if its context is one of shared_context(). Thread
/// safe.
void share_program(const cl::Context& context, const std::string& key, const cl::Program& built);

}  // namespace clpv
