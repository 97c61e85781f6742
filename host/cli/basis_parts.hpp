// SPDX-License-Identifier: MIT
// Part of `clpv basis`: the paper's figures.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "basis/rotated_lobe.hpp"

namespace clpv {

struct BasisFigures {
  std::vector<std::unique_ptr<Basis>> bases;  ///< bases of Figures 3 and 6; empty: the paper's
  LobeOptions lobes;
  double lambda = kDefaultLambda;  ///< bandwidth of the eight functions in Figure 2
};
/// Draws with python/clpv/draw into `folder`, which is created if missing. Returns the paths of
///   figure2.png  the Poisson kernel with lambda 0.4; the eight functions of srbf8v2, joint and one
///                by one
///   figure3.png  the clamped cosine along +z and along (-2, 1, -3), and each basis's lobe for it
///   figure6.png  the same along the six main axes
/// Throws Error(run_time) if a file is not writable, or Python or a module is missing.
std::vector<std::filesystem::path> write_basis_figures(BasisFigures figures,
                                                       const std::filesystem::path& folder);

}  // namespace clpv
