// SPDX-License-Identifier: MIT
#include "pipeline/steps/transmittance.hpp"

namespace clpv {

LinkTransmittance::LinkTransmittance(Session& session, const Basis& basis,
                                     const Transport& transport, int grid,
                                     const VolumeFormat& format)
    : LinkTransmittance(session, transmittance_source(basis, transport), grid, format) {}

LinkTransmittance::LinkTransmittance(Session& session, const TransmittanceSource& source, int grid,
                                     const VolumeFormat& format)
    : stencil_(grid, format, lanes_of(session.device(), format)),
      operations_(source.operations),
      kernel_(session, {"steps/transmittance.cl", stencil_.literals(), source.text}, "transmit"),
      transmittance_(session, {grid, source.links, 1}, "transmittance", format) {}

void LinkTransmittance::transmit(const Volume& geometry) {
  kernel_.set(geometry.memory(), transmittance_.memory());
  stencil_.launch(kernel_, 1);
}

}  // namespace clpv
