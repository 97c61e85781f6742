// SPDX-License-Identifier: MIT
#include "commands/misspelt.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "support/error.hpp"

namespace clpv {
namespace {

constexpr std::size_t kMostEdits = 2;  // "rendr" and "qualtiy" have one and two

/// Levenshtein's distance: letters put in, left out or replaced.
std::size_t edits(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

}  // namespace

void refuse_misspelt_command(const CLI::App& app) {
  const std::vector<std::string> words = app.remaining();
  const auto word = std::ranges::find_if(words, [](const std::string& w) { return !w.starts_with('-'); });
  if (word == words.end()) return;
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
  const auto nearest =
      std::ranges::min_element(names, {}, [&](const std::string& n) { return edits(*word, n); });
  if (edits(*word, *nearest) <= kMostEdits)
    throw Error(ExitCode::usage, "'{}' is no command; did you mean {}?", *word, *nearest);
  throw Error(ExitCode::usage, "'{}' is no command; allowed: {}", *word, fmt::join(names, ", "));
}

}  // namespace clpv
