// SPDX-License-Identifier: MIT
// Runs a command in a process and returns its output.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/support/temporary_folder.hpp"

namespace clpv::test {

struct Outcome {
  int exit_code = -1;  ///< 128 + signal where one ended it
  std::string out, err;
};

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
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
