// SPDX-License-Identifier: MIT
// Generates the text of injection kernels for a basis (kernels/inject/inject.cl). Independent of OpenCL.
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/blocking.hpp"
#include "basis/rotated_lobe.hpp"

namespace clpv {

/// Text for light, without literals. lobe_source() defines the functions below; inject_source() adds the basis's
/// functions.
///   Coefficients lobe_integrals(x, y, z CLPV_PASS_TABLE)   alpha of the lobe about the unit normal
///   float lobe_flux(Coefficients alpha)         integral of the lobe with integrals alpha [sr]
///   Coefficients project_sum(Coefficients a)                A^-1 a
/// Rotated lobes of a basis with centres follow the macros of their LookupTable.
std::string lobe_source(const Basis& basis, const LobeOptions& lobes);
std::string inject_source(const Basis& basis, const LobeOptions& lobes);

/// Text for blockers: project_sum, and
///   Coefficients surfel_blocker(x, y, z CLPV_PASS_TABLE)            contribution of a surfel of share 1, before projection
///   Coefficients merge_blockers(Coefficients a, Coefficients b)       blocking of two sources that see the same surface
/// Lobes as above; areas need no table.
std::string blocker_source(const Basis& basis, const LobeOptions& lobes, Blocking blocking);

}  // namespace clpv
