// SPDX-License-Identifier: MIT
// Linear transports: the free-space transport equation discretised on cells and projected on the basis
// (docs/method.md, Propagation).
#pragma once

#include "basis/transport.hpp"

namespace clpv {

/// R_k = A^-1 Int b b^T max(0, w . k) / |w|_1 dw, k the six axes: first-order upwind.
/// `inverse_norm` receives K = A^-1 Int b b^T / |w|_1 dw.
OperatorTransport make_upwind(const Basis& basis, Matrix& inverse_norm);

}  // namespace clpv
