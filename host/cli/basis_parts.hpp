// SPDX-License-Identifier: MIT
// Parts of `clpv basis`: report on a basis, search for centres, and the paper's figures.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <glm/glm.hpp>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "basis/centre_search.hpp"
#include "basis/rotated_lobe.hpp"
#include "support/named_enum.hpp"

namespace clpv {

/// Lobe method, and the axis of the reported lobe.
struct BasisView {
  LobeOptions lobes;
  glm::dvec3 axis;  ///< unit
};

/// Describes a basis as a JSON object.
nlohmann::json describe(const Basis& basis, const BasisView& view);
/// Formats one line per object, including "error_over" (error_over() of a search's aims) if present.
std::string table_of(const nlohmann::json& bases);

/// Clamped cosines of a search without a weights file.
enum class SearchedCosines { all, axes };
template <>
inline constexpr auto kNames<SearchedCosines> = name_list("all", "axes");

struct BasisSearchOptions {
  std::optional<int> centres;  ///< empty: no search
  SearchedCosines over = SearchedCosines::all;
  std::string weights, output;
  CentreSearch search;
};
void add_search_options(CLI::App& command, BasisSearchOptions& options);
/// `clpv basis --search N`: finds the centres with the smallest clamped-cosine error. Writes the file for --centres,
/// and prints the set's metrics and those of the named sets.
void print_search(const BasisSearchOptions& options, double lambda, const BasisView& view, bool json);

struct BasisFigures {
  std::vector<std::unique_ptr<Basis>> bases;  ///< bases of Figures 3 and 6; empty: the paper's
  LobeOptions lobes;
  double lambda = kDefaultLambda;  ///< bandwidth of the eight functions in Figure 2
};
/// Draws with python/clpv/draw into `folder`, which is created if missing. Returns the paths of
///   figure2.png  the Poisson kernel with lambda 0.4; the eight functions of srbf8v2, joint and one by one
///   figure3.png  the clamped cosine along +z and along (-2, 1, -3), and each basis's lobe for it
///   figure6.png  the same along the six main axes
/// Throws Error(run_time) if a file is not writable, or Python or a module is missing.
std::vector<std::filesystem::path> write_basis_figures(BasisFigures figures,
                                                       const std::filesystem::path& folder);

}  // namespace clpv
