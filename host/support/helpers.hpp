// SPDX-License-Identifier: MIT
// Helper processes: the same program, started once per core, that shares out a list of jobs with
// its siblings.
//
// PoCL compiles one kernel at a time in a process, but processes compile side by side and share its
// cache: with empty caches and two cores a first image takes 17 s in place of 27 (docs/devices.md).
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "support/cache_folder.hpp"
#include "support/process.hpp"

namespace clpv {

/// Sets the file of this program, which helpers run. Without it, as in a library, there are no
/// helpers.
void set_helper_program(std::string file);

/// Returns true if set_helper_program() was called.
bool has_helper_program();

/// Number of helpers worth starting: one per core; 0 on one core or without a program.
unsigned helper_count();

/// Jobs of helpers that share a folder. Each job is taken by one of them.
class Claims {
 public:
  explicit Claims(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// Returns true in the first process that takes the job `name`. Throws Error(run_time) if the
  /// folder cannot be written.
  bool take(const std::string& name) const;
  /// Records that the job `name` is done, with its result.
  void finish(const std::string& name, const std::string& result = {}) const;
  /// Returns true if some process finished the job.
  bool finished(const std::string& name) const;
  /// Returns the result of a finished job.
  std::string result(const std::string& name) const;
  /// Returns the process that took the job and the time since then; empty if no one did.
  struct Taken {
    pid_t process;
    std::chrono::duration<double> age;
  };
  std::optional<Taken> taken(const std::string& name) const;
  std::size_t finished_count() const;

 private:
  std::filesystem::path folder_;
};

/// Processes of this program, and the folder of their claims.
class Helpers {
 public:
  /// Starts `count` times `clpv arguments... --claims FOLDER`. Throws Error(run_time) if the
  /// temporary folder cannot be made.
  explicit Helpers(std::vector<std::string> arguments, unsigned count = helper_count());
  ~Helpers();  ///< ends helpers that still run, and removes the folder
  Helpers(const Helpers&) = delete;
  Helpers& operator=(const Helpers&) = delete;

  /// Starts one more.
  void start();
  /// Waits a moment. Returns true while a helper runs.
  bool wait();
  /// Ends a helper at once, with SIGKILL.
  void kill(pid_t process);
  /// Helpers that wait() found to have ended, in that order.
  struct Ended {
    pid_t process;
    int code;  ///< Process::Result::code
    std::string output;
  };
  const std::vector<Ended>& ended() const { return ended_; }
  const Claims& claims() const { return claims_; }
  /// Returns the output of failed helpers once wait() returned false; empty if all succeeded.
  std::string failures() const;

 private:
  ScratchFolder folder_;
  Claims claims_;
  std::vector<std::string> arguments_;
  std::vector<std::unique_ptr<Process>> children_;  ///< that run
  std::vector<Ended> ended_;
};

/// In a helper: a signal ends this process at once.
void become_helper();

/// Returns the file that set_helper_program() set; empty without one.
const std::string& this_program();

}  // namespace clpv
