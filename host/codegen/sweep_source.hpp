// SPDX-License-Identifier: MIT
// Constants of the sweep's kernels as text (kernels/sweep/).
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/sweep.hpp"
#include "codegen/constants.hpp"

namespace clpv {

/// For sweep_links.cl: the text of transmittance_source, CLPV_AXIS_LINKS and CLPV_VOLUME_LINKS.
std::string sweep_links_text(const Basis& basis, const Transport& transport);

/// For sweep_collect.cl: Coefficients of swept_basis(), and CLPV_PROJECTION, 24 x 9:
/// swept_projection() by folded bins.
std::string sweep_collect_text();
/// Operations per cell and channel.
OperationCount sweep_collect_operations();

/// For bounce.cl: Coefficients of `basis`, CLPV_INCIDENT, 6 x 24, CLPV_LOBES, 6 x N, and
/// CLPV_MAX_RETURNED.
std::string bounce_source_text(const Basis& basis);

/// For sweep_medium.cl: CLPV_SCATTERING, 3 x 24: scattering_matrix(anisotropy) by folded bins,
/// first bin of each axis.
std::string scatter_source_text(double anisotropy);

}  // namespace clpv
