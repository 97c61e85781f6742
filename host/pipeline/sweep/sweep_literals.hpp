// SPDX-License-Identifier: MIT
// Tables of the sweep's kernels (kernels/sweep/).
#pragma once

#include "basis/basis.hpp"
#include "basis/sweep.hpp"
#include "support/literals.hpp"

namespace clpv {

/// Literals of sweep_source.cl: what add_coefficient_literals() adds for `basis`.
Literals source_literals(const Basis& basis);

/// For sweep_links.cl: those of link_literals(), CLPV_AXIS_LINKS and CLPV_VOLUME_LINKS.
Literals sweep_links_literals(const Basis& basis, const Transport& transport);

/// For sweep_collect.cl: those of coefficients of swept_basis(), and CLPV_PROJECTION, 24 x 9:
/// swept_projection() by folded bins.
Literals sweep_collect_literals(double most_white);

/// For bounce.cl: those of coefficients of `basis`, CLPV_INCIDENT, 6 x 24, CLPV_LOBES, 6 x N, and
/// CLPV_MAX_RETURNED.
Literals bounce_literals(const Basis& basis);

/// For sweep_medium.cl: CLPV_SCATTERING, 3 x 24: scattering_matrix(anisotropy) by folded bins,
/// first bin of each axis.
Literals scattering_literals(double anisotropy);

}  // namespace clpv
