// SPDX-License-Identifier: MIT
// A child process with optional input and captured output.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace clpv {

/// Undoes what a parent may have left: SIGCHLD ignored, which loses the status of children; blocked
/// signals, which nothing would interrupt; closed standard streams. For the start of a program.
void reset_inherited_state();

/// Removes the entries of PATH that depend on the current folder, since a scene's folder may hold
/// anything. For drivers that start programs, as PoCL starts ld.
void keep_absolute_path_entries();

/// Returns the file of a program in the absolute entries of PATH.
std::optional<std::filesystem::path> find_program(const std::string& name);

/// A child process, started without a shell. The kernel ends it with the thread that started it,
/// also after SIGKILL, so that it writes nothing later.
class Process {
 public:
  struct Result {
    int code = -1;  ///< exit status; 128 + signal; -1 if it did not start or its status is lost
    std::string output;  ///< stdout and stderr; the reason where the code is -1
  };

  /// Starts the program of that file. `with_input`: its stdin reads the bytes of feed(); else stdin
  /// is empty. end() reports a failure to start.
  Process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
          bool with_input = false);
  ~Process();  ///< closes its input and waits for it to exit
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Writes `bytes` to its stdin; blocks while it reads slowly. Returns false if it has closed
  /// stdin.
  bool feed(std::span<const std::byte> bytes);

  pid_t id() const { return child_; }  ///< -1 if it did not start, and after end()
  /// Returns true until the process has exited.
  bool running();
  /// Ends the process at once, with SIGKILL, and the processes that it started.
  void kill();

  /// Closes its stdin and waits for it to exit; an interrupt kills it.
  Result end();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, Close> output_;  ///< a file in memory
  int input_ = -1;
  pid_t child_ = -1;
  int status_ = 0;  ///< set by waitpid, once exited_
  bool exited_ = false;
  int lost_ = 0;         ///< errno of waitpid, where it knows no such child
  int start_error_ = 0;  ///< errno of a failure to start
};

}  // namespace clpv
