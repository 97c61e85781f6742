// SPDX-License-Identifier: MIT
// The kernel text of an SRBF set (Basis::kernel_source): antipodal centres of one lambda share all but a sign.
#pragma once

#include <map>
#include <string>

#include "basis/basis.hpp"
#include "basis/clamped_cosine.hpp"

namespace clpv {

/// `cosines` by lambda.
std::string srbf_kernel_source(const Basis& basis, const std::map<double, CosineOfPoisson>& cosines);

}  // namespace clpv
