// SPDX-License-Identifier: MIT
// The text of kernels/transmittance.cl: what blockers let through on each link into a cell.
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "codegen/linear_code.hpp"

namespace clpv {

/// Generated text for kernels/transmittance.cl, for one transport and what it is blocked by: link_macros(), and CLPV_TRANSMITTANCE, which
/// declares `links` from the cell's corners g0 .. g7 (bit 0 x, 1 y, 2 z).
/// Links are numbered as FaceTransport::faces are, or as sweep_links() are.
struct TransmittanceSource {
  std::string text;
  OperationCount operations;  ///< a cell
  int links = 0;
};
TransmittanceSource transmittance_source(const Basis& basis, const Transport& transport);

/// The struct Links of so many floats, CLPV_EACH_LINK(DO) and CLPV_LINKS.
std::string link_macros(int links);

}  // namespace clpv
