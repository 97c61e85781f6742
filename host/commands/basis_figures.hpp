// SPDX-License-Identifier: MIT
// The paper's figures of bases and lobes, drawn by tools/clpv_draw.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "basis/rotated_lobe.hpp"

namespace clpv {

struct BasisFigures {
  std::vector<std::unique_ptr<Basis>> bases;  ///< of Figures 3 and 6
  LobeOptions lobes;
  double lambda = kDefaultLambda;  ///< of the eight functions in Figure 2
};

/// The bases that the paper draws.
std::vector<std::unique_ptr<Basis>> paper_bases(double lambda);

/// Writes, into `folder`, created where it is not there:
///   figure2.png  the Poisson kernel with lambda .4; the eight functions of srbf8v2, joint and one by one
///   figure3.png  the clamped cosine along +z and along (-2, 1, -3), and each basis's lobe for it
///   figure6.png  the same along the six main axes
/// and returns their paths. Throws Error(run_time) where a file cannot be written, or Python or a module is missing.
std::vector<std::filesystem::path> write_basis_figures(const BasisFigures& figures,
                                                       const std::filesystem::path& folder);

}  // namespace clpv
