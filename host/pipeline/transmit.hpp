// SPDX-License-Identifier: MIT
// What blockers let through: a cascade's geometry volume as the share of light that each way into a cell passes.
#pragma once

#include <string>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "codegen/linear_code.hpp"
#include "device/session.hpp"
#include "pipeline/stencil.hpp"
#include "volume/volume.hpp"

namespace clpv {

/// Generated text for kernels/transmit.cl, for one transport and what it is blocked by: way_macros(), and CLPV_TRANSMITTANCE, which
/// declares `ways` from the cell's corners g0 .. g7 (bit 0 x, 1 y, 2 z).
/// Ways are numbered as FaceTransport::faces are, or as the neighbours of an OperatorTransport but the cell itself.
struct TransmitSource {
  std::string text;
  OperationCount operations;  ///< a cell
  int ways = 0;
};
TransmitSource transmit_source(const Basis& basis, const Transport& transport);

/// The struct Ways of so many floats, CLPV_EACH_WAY(DO) and CLPV_WAYS.
std::string way_macros(int ways);

/// Evaluates 1 - B of every way once, so that each propagation step reads numbers in place of a basis: a step then
/// costs the same whatever blocks.
class Transmitter {
 public:
  Transmitter(Session& session, const Basis& basis, const Transport& transport,
              const StencilOptions& options);

  void transmit(const Volume& geometry);  ///< (grid + 1)^3 corners, one channel

  /// grid^3 cells, one number in [0, 1] a way, one channel.
  const Volume& transmittance() const { return transmittance_; }
  const OperationCount& operations() const { return operations_; }

 private:
  Transmitter(Session& session, const TransmitSource& source, const StencilOptions& options);

  Stencil stencil_;
  OperationCount operations_;
  Kernel kernel_;
  Volume transmittance_;
};

}  // namespace clpv
