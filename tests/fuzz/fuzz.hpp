// SPDX-License-Identifier: MIT
// Helpers of the fuzz targets. A target is a file NAME_fuzz.cpp with one LLVMFuzzerTestOneInput:
// libFuzzer calls it with generated inputs (scripts/fuzz), replay.cpp with those of corpus/NAME and
// blind mutants of them (a test of every build).
//
// An input is read or rejected. Whatever else happens is a finding: a crash, a sanitizer's report,
// an exception of another kind, or an error of another exit code than those a target allows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <string_view>

#include "support/error.hpp"
#include "tests/support/temporary_folder.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace clpv::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// The process's folder for small files, in memory where possible.
inline const test::TemporaryFolder& folder() {
  static const bool in_memory = [] {
    if (std::filesystem::is_directory("/dev/shm")) ::setenv("TMPDIR", "/dev/shm", 0);
    return true;
  }();
  static const test::TemporaryFolder made;
  static_cast<void>(in_memory);
  return made;
}

/// Runs `read`; it may reject its input, but only with these exit codes.
template <typename Read>
void read_or_reject(std::initializer_list<ExitCode> allowed, Read&& read) {
  try {
    read();
  } catch (const Error& error) {
    for (const ExitCode code : allowed) {
      if (error.code() == code) return;
    }
    std::fprintf(stderr, "exit code %d is not this reader's: %s\n", static_cast<int>(error.code()),
                 error.what());
    std::abort();
  }
}

}  // namespace clpv::fuzz
