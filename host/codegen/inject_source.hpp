// SPDX-License-Identifier: MIT
// Kernel text that injection generates for a basis. Knows no OpenCL.
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/blocking.hpp"
#include "basis/rotated_lobe.hpp"

namespace clpv {

/// What kernels/inject.cl is compiled with for light, besides literals: the basis's functions and, also by themselves,
///   Coefficients clpv_lobe_integrals(x, y, z CLPV_PASS_TABLE)   alpha of the lobe round the unit normal
///   float clpv_flux(Coefficients alpha)         Int of the lobe with those integrals alpha [sr]
///   Coefficients clpv_project_sum(Coefficients a)                A^-1 a
/// Rotated lobes of a basis with centres come after the macros of their LookupTable.
std::string lobe_source(const Basis& basis, const LobeOptions& lobes);
std::string inject_source(const Basis& basis, const LobeOptions& lobes);

/// The same for blockers: clpv_project_sum, and
///   Coefficients clpv_blocker(x, y, z CLPV_PASS_TABLE)            what a surfel of share 1 adds, by its unit normal, to be
///                                                                 projected
///   Coefficients clpv_merge(Coefficients a, Coefficients b)       of two surfaces that see the same
/// Lobes as above; areas look nothing up.
std::string blocker_source(const Basis& basis, const LobeOptions& lobes, Blocking blocking);

}  // namespace clpv
