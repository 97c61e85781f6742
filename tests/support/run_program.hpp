// SPDX-License-Identifier: MIT
// Runs a command in a process and returns its output.
#pragma once

#include <sys/stat.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

#include "support/cache_folder.hpp"

namespace clpv::test {

// A temporary folder for a test's files.

/// A fresh folder of this object, removed with it.
struct TemporaryFolder : ScratchFolder {
  std::filesystem::path operator/(const std::string& name) const { return path() / name; }

  /// Writes a file, with the folders on its way; its path.
  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    const std::filesystem::path path = *this / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
};

// Variables of the environment during a test.

/// A variable with another value, or none; restored at the end.
class Variable {
 public:
  explicit Variable(const char* name) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
  }
  Variable(const char* name, const std::optional<std::string>& value) : Variable(name) {
    set(value);
  }
  Variable(const Variable&) = delete;
  ~Variable() { set(before_); }

  void set(const std::optional<std::string>& value) const {
    value ? ::setenv(name_, value->c_str(), 1) : ::unsetenv(name_);
  }

 private:
  const char* name_;
  std::optional<std::string> before_;
};

struct Outcome {
  int exit_code = -1;  ///< 128 + signal where one ended it
  std::string out, err;
};

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Mode bits of a file, or of a link.
inline mode_t mode_of(const std::filesystem::path& path) {
  struct stat found {};
  return ::lstat(path.c_str(), &found) == 0 ? found.st_mode & 07777 : 0;
}

/// `command` through the shell: "VARIABLE=value PROGRAM arguments".
inline Outcome run(const std::string& command) {
  const TemporaryFolder folder;
  const auto out = folder.path() / "out", err = folder.path() / "err";
  const int status =
      std::system(("( " + command + " ) >" + out.string() + " 2>" + err.string()).c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return {code, read_file(out), read_file(err)};
}

/// "POCL_CACHE_DIR=... ", for a process whose XDG_CACHE_HOME is empty: PoCL would compile all
/// kernels again there.
inline std::filesystem::path usual_kernels_folder() {
  if (const char* set = std::getenv("POCL_CACHE_DIR")) return set;
  if (const char* cache = std::getenv("XDG_CACHE_HOME"))
    return std::filesystem::path(cache) / "clpv/pocl";
  const char* home = std::getenv("HOME");
  return std::filesystem::path(home != nullptr ? home : "/nonexistent") / ".cache/clpv/pocl";
}
inline std::string usual_kernels() {
  return "POCL_CACHE_DIR=" + usual_kernels_folder().string() + " ";
}

}  // namespace clpv::test
