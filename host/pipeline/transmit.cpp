// SPDX-License-Identifier: MIT
#include "pipeline/transmit.hpp"

namespace clpv {

Transmitter::Transmitter(Session& session, const Basis& basis, const Transport& transport,
                         const StencilOptions& options)
    : Transmitter(session, transmit_source(basis, transport), options) {}

Transmitter::Transmitter(Session& session, const TransmitSource& source, const StencilOptions& options)
    : stencil_(session.device(), options),
      operations_(source.operations),
      kernel_(session, {"transmit.cl", stencil_.literals(), source.text}, "transmit"),
      transmittance_(session, {options.grid, source.ways, 1}, "transmittance", options.format) {}

void Transmitter::transmit(const Volume& geometry) {
  kernel_.set(geometry.memory(), transmittance_.memory());
  stencil_.launch(kernel_, 1);
}

}  // namespace clpv
