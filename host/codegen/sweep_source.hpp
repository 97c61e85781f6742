// SPDX-License-Identifier: MIT
// Generated text of the kernels that sweep and bounce (kernels/sweep*.cl, kernels/bounce.cl).
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/sweep.hpp"
#include "codegen/linear_code.hpp"

namespace clpv {

/// "#define CLPV_EACH_X_BIN(DO) DO(0) ..." and the like: the bins that are swept across each axis, those across x first.
std::string sweep_bin_macros();
/// Generated text, and what it executes a cell and channel.
struct CountedText {
  std::string text;
  OperationCount operations;
};
/// For sweep_source.cl: coefficient_macros, the struct Swept, and clpv_bin_means.
CountedText sweep_source_text(const Basis& basis);
/// For sweep_links.cl: transmittance_source's text, and which links go where.
std::string sweep_links_text(const Basis& basis, const Transport& transport);
/// For sweep_collect.cl: coefficient_macros of swept_basis(), the struct Swept, and clpv_projected.
CountedText sweep_collect_text();

/// For bounce.cl: coefficients of six sides, Swept of 24 bins, clpv_arriving and clpv_leaving.
std::string bounce_source_text();
/// For sweep_collect.cl of all bounces: Sides, and Sides clpv_arriving(Swept).
std::string arriving_source_text();

}  // namespace clpv
