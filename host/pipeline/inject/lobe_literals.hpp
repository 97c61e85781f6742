// SPDX-License-Identifier: MIT
// Tables of kernels/basis/lobe.h.
#pragma once

#include "basis/basis.hpp"
#include "basis/rotated_lobe.hpp"
#include "support/literals.hpp"

namespace clpv {

/// The basis's tables and those of its lobes, besides what add_coefficient_literals() and, for
/// rotated lobes, LookupTable::add_literals() add.
Literals lobe_literals(const Basis& basis, const LobeOptions& lobes);

}  // namespace clpv
