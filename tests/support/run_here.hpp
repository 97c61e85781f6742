// SPDX-License-Identifier: MIT
// Runs the program in this process and returns output and exit code, which saves its start-up time.
// Tests of environment variables, signals and broken streams use run_program.hpp.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "cli/commands.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::test {

/// Words between blanks; '...' keeps blanks together.
inline std::vector<std::string> words_of(std::string_view text) {
  std::vector<std::string> words;
  bool quoted = false, in_word = false;
  for (const char c : text) {
    if (c == '\'') quoted = !quoted;
    if (c == ' ' && !quoted) {
      in_word = false;
      continue;
    }
    if (!in_word) words.emplace_back();
    in_word = true;
    if (c != '\'') words.back() += c;
  }
  return words;
}

/// `clpv arguments`, in that folder.
inline Outcome run_here(std::string_view arguments, const std::filesystem::path& folder = ".",
                        const Additions& additions = {}) {
  std::vector<std::string> words = words_of(arguments);
  words.insert(words.begin(), "clpv");
  std::vector<const char*> pointers;
  for (const std::string& word : words) pointers.push_back(word.c_str());
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder);
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Outcome outcome;
  outcome.exit_code = run_program(static_cast<int>(pointers.size()), pointers.data(), additions);
  outcome.out = ::testing::internal::GetCapturedStdout();
  outcome.err = ::testing::internal::GetCapturedStderr();
  std::filesystem::current_path(before);
  return outcome;
}

/// run_here() of a command that must end with 0.
inline Outcome must_run_here(std::string_view arguments,
                             const std::filesystem::path& folder = ".") {
  Outcome outcome = run_here(arguments, folder);
  EXPECT_EQ(outcome.exit_code, 0) << arguments << '\n' << outcome.err;
  return outcome;
}

}  // namespace clpv::test
