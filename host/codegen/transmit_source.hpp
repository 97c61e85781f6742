// SPDX-License-Identifier: MIT
// The text of kernels/transmit.cl: what blockers let through on each way into a cell.
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "codegen/linear_code.hpp"

namespace clpv {

/// Generated text for kernels/transmit.cl, for one transport and what it is blocked by: way_macros(), and CLPV_TRANSMITTANCE, which
/// declares `ways` from the cell's corners g0 .. g7 (bit 0 x, 1 y, 2 z).
/// Ways are numbered as FaceTransport::faces are, or as sweep_ways() are.
struct TransmitSource {
  std::string text;
  OperationCount operations;  ///< a cell
  int ways = 0;
};
TransmitSource transmit_source(const Basis& basis, const Transport& transport);

/// The struct Ways of so many floats, CLPV_EACH_WAY(DO) and CLPV_WAYS.
std::string way_macros(int ways);

}  // namespace clpv
