// SPDX-License-Identifier: MIT
// `clpv basis --search N`: centres that hold clamped cosines best, as a file for --centres, beside the named sets.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "basis/centre_search.hpp"
#include "commands/basis_table.hpp"
#include "support/named_enum.hpp"

namespace clpv {

/// Clamped cosines that a search is for, where no file says so.
enum class SearchedCosines { all, axes };
template <>
inline constexpr auto kNames<SearchedCosines> = name_list("all", "axes");

struct BasisSearchOptions {
  std::optional<int> centres;  ///< none: no search
  SearchedCosines over = SearchedCosines::all;
  std::string weights, output;
  CentreSearch search;
};

void add_search_options(CLI::App& command, BasisSearchOptions& options);

/// Searches, writes the file, and prints the set's figures beside those of others.
void search_and_tell(const BasisSearchOptions& options, double lambda, const BasisView& view, bool json);

}  // namespace clpv
