// SPDX-License-Identifier: MIT
#include "pipeline/steps/transmittance.hpp"

namespace clpv {

LinkTransmittance::LinkTransmittance(Session& session, const Basis& basis, const Transport& transport,
                                     const StencilOptions& options)
    : LinkTransmittance(session, transmittance_source(basis, transport), options) {}

LinkTransmittance::LinkTransmittance(Session& session, const TransmittanceSource& source,
                                     const StencilOptions& options)
    : stencil_(session.device(), options),
      operations_(source.operations),
      kernel_(session, {"steps/transmittance.cl", stencil_.literals(), source.text}, "transmit"),
      transmittance_(session, {options.grid, source.links, 1}, "transmittance", options.format) {}

void LinkTransmittance::transmit(const Volume& geometry) {
  kernel_.set(geometry.memory(), transmittance_.memory());
  stencil_.launch(kernel_, 1);
}

}  // namespace clpv
