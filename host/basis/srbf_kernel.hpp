// The kernel text of an SRBF set (Basis::kernel_source): antipodal centres share everything but a sign.
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/clamped_cosine.hpp"

namespace clpv {

std::string srbf_kernel_source(const Basis& basis, const CosineOfPoisson& cosine);

}  // namespace clpv
