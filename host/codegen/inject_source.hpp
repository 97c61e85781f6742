// SPDX-License-Identifier: MIT
// Generates the text of injection kernels for a basis (kernels/inject/inject.cl). Independent of
// OpenCL.
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/blocking.hpp"
#include "basis/rotated_lobe.hpp"

namespace clpv {

/// For inject.cl with light: Coefficients and lobe_source().
std::string inject_source(const Basis& basis, const LobeOptions& lobes);

/// For kernels/inject/lobe.h: the basis's functions and what that header names. Rotated lobes of a
/// basis with centres follow the macros of their LookupTable.
std::string lobe_source(const Basis& basis, const LobeOptions& lobes);

/// For inject.cl with blockers (kernels/inject/blocking.h). Lobes as above; areas need no table.
std::string blocker_source(const Basis& basis, const LobeOptions& lobes, Blocking blocking);

}  // namespace clpv
