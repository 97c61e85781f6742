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
/// `clamp`: sets fluxes below 0 to 0, as the kernels do; without it, energy is conserved exactly.
Volume propagate_step(const Transport& transport, const Volume& travelling, const Volume* geometry,
                      bool clamp = true);

/// Result of several steps.
struct Propagation {
  Volume travelling;   ///< light after the last step
  Volume accumulated;  ///< sum of the injected light and the result of each step
};
/// Runs `iterations` steps; the first one is not blocked.
Propagation propagate(const Transport& transport, const Volume& injected, const Volume* geometry,
                      int iterations, bool clamp = true);

/// Returns the sum of Int f dw over all cells, per channel [W].
std::array<double, 3> energy(const Basis& basis, const Volume& volume);

/// Returns the energy that the step from `travelling` transports out of the grid, per channel [W].
std::array<double, 3> escaping_energy(const Basis& basis, const Transport& transport,
                                      const Volume& travelling);

}  // namespace clpv::reference
