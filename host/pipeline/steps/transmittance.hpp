// SPDX-License-Identifier: MIT
// Transmittance of a cascade's links, computed from its geometry volume.
#pragma once

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/session.hpp"
#include "pipeline/steps/stencil.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Constants of kernels/steps/link_transmittance.h for one transport and blocking mode. Links are
/// numbered like FaceTransport::faces or sweep_links().
struct LinkConstants {
  Literals literals;  ///< the geometry volume's coefficients, CLPV_LINKS, CLPV_LINK_SIDES
                      ///< and CLPV_LINK_BLOCKED
  int links = 0;
};
LinkConstants link_constants(const Basis& basis, const Transport& transport);

/// Evaluates 1 - B of every link once. Propagation steps then read numbers and evaluate no basis,
/// so their time does not depend on the blockers.
class LinkTransmittance {
 public:
  /// `format`: of geometry and transmittance volumes.
  LinkTransmittance(Session& session, const Basis& basis, const Transport& transport, int grid,
                    const VolumeFormat& format);

  void transmit(const Volume& geometry);  ///< (grid + 1)^3 corners, one channel

  /// grid^3 cells, one number in [0, 1] per link, one channel.
  const Volume& transmittance() const { return transmittance_; }

 private:
  LinkTransmittance(Session& session, const LinkConstants& constants, int grid,
                    const VolumeFormat& format);

  Stencil stencil_;
  Kernel kernel_;
  Volume transmittance_;
};

}  // namespace clpv
