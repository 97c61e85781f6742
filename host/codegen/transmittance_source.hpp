// SPDX-License-Identifier: MIT
// Constants of the transmittance of each link into a cell (kernels/steps/link_transmittance.h).
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "codegen/constants.hpp"

namespace clpv {

/// Text for one transport and blocking mode: the geometry volume's Coefficients, link_text(),
/// CLPV_LINK_SIDES and CLPV_LINK_BLOCKED. Links are numbered like FaceTransport::faces or
/// sweep_links().
struct TransmittanceSource {
  std::string text;
  OperationCount operations;  ///< per cell, each sum over corners counted for each link
  int links = 0;
};
TransmittanceSource transmittance_source(const Basis& basis, const Transport& transport);

/// CLPV_LINKS, and struct Links, an array c of so many numbers.
std::string link_text(int links);

}  // namespace clpv
