// SPDX-License-Identifier: MIT
// Generates the linear maps of the sweep's kernels as text (kernels/sweep_*.cl, kernels/sweep/bounce.cl).
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/sweep.hpp"
#include "codegen/linear_code.hpp"

namespace clpv {

/// CLPV_X_BINS, the number of bins across x, and macros CLPV_EACH_X_BIN(DO), _Y_ and _Z_, which write DO(bin) for the
/// bins that are swept across an axis; bins across x come first.
std::string sweep_bin_macros();

/// Generated text with the arithmetic operations it executes per cell and channel.
struct CountedText {
  std::string text;
  OperationCount operations;
};
/// For sweep_links.cl: the text of transmittance_source, and macros of the links used across each axis.
std::string sweep_links_text(const Basis& basis, const Transport& transport);
/// For sweep_collect.cl: coefficient_macros of swept_basis(), struct Bins, and Coefficients project_bins(Bins).
CountedText sweep_collect_text();

/// For sweep_collect.cl with CLPV_WITH_INCIDENT: struct FaceFluxes, and FaceFluxes incident_flux(Bins).
std::string incident_flux_text();
/// For bounce.cl: coefficient_macros of `basis`, struct Bins, incident_flux_text(), and
/// Coefficients reflected_intensity(FaceFluxes).
std::string bounce_source_text(const Basis& basis);

/// For sweep_medium.cl: struct Bins, and Bins scatter_bins(Bins), the product with scattering_matrix(anisotropy).
std::string scatter_source_text(double anisotropy);

}  // namespace clpv
