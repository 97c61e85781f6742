// SPDX-License-Identifier: MIT
// Constants of a propagation step for one basis (kernels/steps/propagate.cl).
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "codegen/constants.hpp"

namespace clpv {

/// Text of the basis's Coefficients and of CLPV_FACE_FLUX, CLPV_FACE_NORMAL and CLPV_LOBES, for a
/// transport with faces.
std::string transport_source(const Basis& basis, const Transport& transport);

/// Operations per cell and channel of a step with constant lobes.
OperationCount step_operations(const Transport& transport, bool blocking);

}  // namespace clpv
