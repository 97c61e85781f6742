// SPDX-License-Identifier: MIT
// Tables of kernels/basis/lobe.h.
#pragma once

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "support/literals.hpp"

namespace clpv {

/// Tables of the basis and of its lobes. Call add_coefficient_literals() too and, for rotated
/// lobes, LookupTable::add_literals().
Literals lobe_literals(const Basis& basis, const LobeOptions& lobes);

}  // namespace clpv
