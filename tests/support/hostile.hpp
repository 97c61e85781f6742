// SPDX-License-Identifier: MIT
// Hostile inputs as rows of tables: the files that are made, the command that meets them, how it must end, and the words it
// must say. What is said must not be a library's own words (what(), std::), nor move a terminal's cursor, and nothing may be left
// behind.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "support/text.hpp"
#include "tests/support/run_here.hpp"

namespace clpv::test {

struct HostileInput {
  std::string name;
  std::string command;  ///< "render @/a.gltf": arguments of clpv; @ is the folder
  int exit_code;
  std::vector<std::string> words;                            ///< on stderr
  std::vector<std::pair<std::string, std::string>> files{};  ///< made in the folder: name, bytes
  std::function<void(const TemporaryFolder&)> prepare{};     ///< what is no plain file
  /// "HOME=@ XDG_CACHE_HOME=", or the name of another program, before the program, through the shell; without, the command
  /// runs in this process.
  std::string surroundings{};
};

inline std::string with_folder(std::string text, const TemporaryFolder& folder) {
  for (std::size_t at = 0; (at = text.find('@', at)) != std::string::npos;)
    text.replace(at, 1, folder.path().string());
  return text;
}

/// Longer, and it hangs: all are rejected before anything is computed.
inline constexpr const char* kPatience = "timeout 60 ";

inline void expect_rejected(const HostileInput& input) {
  SCOPED_TRACE(input.name);
  const TemporaryFolder folder;
  for (const auto& [name, bytes] : input.files) folder.write(name, bytes);
  if (input.prepare) input.prepare(folder);
  const std::string command = with_folder(input.command, folder);
  const Outcome outcome = input.surroundings.empty()
                              ? run_here(command, folder.path())
                              : run(with_folder("cd @ && " + input.surroundings + " ", folder) + kPatience +
                                    CLPV_PROGRAM + " " + command);
  EXPECT_EQ(outcome.exit_code, input.exit_code) << outcome.err;
  for (const std::string& word : input.words) EXPECT_THAT(outcome.err, ::testing::HasSubstr(word));
  for (const char* foreign : {"basic_", "std::", "what()", "terminate", "[json.exception.type_error"})
    EXPECT_THAT(outcome.err, ::testing::Not(::testing::HasSubstr(foreign)));
  EXPECT_EQ(outcome.err, printable(outcome.err)) << "moves the cursor";
  EXPECT_LT(outcome.err.size(), 4000u) << "a flood of words";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(
           folder.path(), std::filesystem::directory_options::skip_permission_denied)) {
    const std::string left = entry.path().filename().string();
    EXPECT_FALSE(left.ends_with(".part") || left.ends_with(".new") || left.starts_with("out")) << left;
  }
}

/// `least`: how many there are, so that none is lost unseen.
inline void expect_all_rejected(const std::vector<HostileInput>& inputs, std::size_t least) {
  EXPECT_GE(inputs.size(), least);
  for (const HostileInput& input : inputs) expect_rejected(input);
}

}  // namespace clpv::test
