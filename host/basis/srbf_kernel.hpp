// SPDX-License-Identifier: MIT
// Kernel text of an SRBF basis (Basis::kernel_source()). Antipodal centres of equal lambda share
// their terms but for a sign.
#pragma once

#include <map>
#include <string>

#include "basis/basis.hpp"
#include "basis/clamped_cosine.hpp"

namespace clpv {

/// Returns the text. `cosines`: clamped-cosine integrals for every lambda of the basis.
std::string srbf_kernel_source(const Basis& basis,
                               const std::map<double, CosineOfPoisson>& cosines);

}  // namespace clpv
