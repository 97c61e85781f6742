// SPDX-License-Identifier: MIT
// Generates the transmittance of each link into a cell (kernels/steps/transmittance.cl).
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "codegen/linear_code.hpp"

namespace clpv {

/// Text for one transport and blocking mode: link_macros(), and CLPV_TRANSMITTANCE, which declares `links` from the
/// cell's corners g0 .. g7 (bit 0 x, 1 y, 2 z). Links are numbered like FaceTransport::faces or sweep_links().
struct TransmittanceSource {
  std::string text;
  OperationCount operations;  ///< per cell
  int links = 0;
};
TransmittanceSource transmittance_source(const Basis& basis, const Transport& transport);

/// struct Links of `links` numbers, CLPV_EACH_LINK(DO) and CLPV_LINKS.
std::string link_macros(int links);

}  // namespace clpv
