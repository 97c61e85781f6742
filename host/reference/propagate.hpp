// SPDX-License-Identifier: MIT
// CPU reference of stage `propagate` (kernels/steps/propagate.cl), in double: steps of light
// between neighbouring cells (Kaplanyan and Dachsbacher 2010; docs/method.md, 'Propagation').
#pragma once

#include <array>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "reference/volume.hpp"

namespace clpv::reference {

/// Returns the light after one step. `travelling`: n^3 cells, N coefficients [W/sr]. `geometry`:
/// (n+1)^3 corners in the representation transport.blocking, one channel; null: no blockers.
/// Fluxes below 0 become 0, as in the kernels.
Volume propagate_step(const Transport& transport, const Volume& travelling, const Volume* geometry);

/// Result of several steps.
struct Propagation {
  Volume travelling;   ///< light after the last step
  Volume accumulated;  ///< sum of the injected light and the result of each step
};
/// Runs `iterations` steps; the first one is not blocked.
Propagation propagate(const Transport& transport, const Volume& injected, const Volume* geometry,
                      int iterations);

/// Returns the sum of Int f dw over all cells, per channel [W].
std::array<double, 3> energy(const Basis& basis, const Volume& volume);

}  // namespace clpv::reference
