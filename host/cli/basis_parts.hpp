// SPDX-License-Identifier: MIT
// The parts of `clpv basis`: what it tells of a basis, the search for centres, and the paper's figures.
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

/// How lobes are made, and along which axis one is looked at.
struct BasisView {
  LobeOptions lobes;
  glm::dvec3 axis;  ///< unit
};

/// A basis as an object.
nlohmann::json describe(const Basis& basis, const BasisView& view);
/// A line each; where the objects have "error_over" (error_over(), of a search's aims), that as well.
std::string table_of(const nlohmann::json& bases);

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
/// `clpv basis --search N`: centres that hold clamped cosines best. Writes the file for --centres, and prints the set's
/// figures beside those of the named sets.
void search_and_tell(const BasisSearchOptions& options, double lambda, const BasisView& view, bool json);

struct BasisFigures {
  std::vector<std::unique_ptr<Basis>> bases;  ///< of Figures 3 and 6; none: the paper's
  LobeOptions lobes;
  double lambda = kDefaultLambda;  ///< of the eight functions in Figure 2
};
/// Draws by tools/clpv_draw, into `folder`, created where it is not there, and returns the paths of
///   figure2.png  the Poisson kernel with lambda 0.4; the eight functions of srbf8v2, joint and one by one
///   figure3.png  the clamped cosine along +z and along (-2, 1, -3), and each basis's lobe for it
///   figure6.png  the same along the six main axes
/// Throws Error(run_time) where a file cannot be written, or Python or a module is missing.
std::vector<std::filesystem::path> write_basis_figures(BasisFigures figures,
                                                       const std::filesystem::path& folder);

}  // namespace clpv
