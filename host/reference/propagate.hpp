// SPDX-License-Identifier: MIT
// The CPU reference of kernels/propagate.cl: one step after another in double, a plane at a time (a plane: one coefficient of all
// cells), straight from docs/method.md, 'Propagation'.
#pragma once

#include <array>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "reference/volume.hpp"

namespace clpv::reference {

/// One step. `travelling`: n^3 cells, N coefficients [W/sr]; `geometry`: (n+1)^3 corners of what transport.blocking says,
/// one channel, or null. `clamp`: fluxes below 0 are dropped, as the kernels do; without it energy is conserved exactly.
Volume propagate_step(const Transport& transport, const Volume& travelling, const Volume* geometry,
                      bool clamp = true);

struct Propagation {
  Volume travelling;   ///< after the last step
  Volume accumulated;  ///< the injected field and every step's output
};
/// `iterations` steps; the first does not block.
Propagation propagate(const Transport& transport, const Volume& injected, const Volume* geometry,
                      int iterations, bool clamp = true);

/// Int f dw summed over all cells, a channel [W].
std::array<double, 3> energy(const Basis& basis, const Volume& volume);

/// What the step from `travelling` sends out of the grid, a channel [W].
std::array<double, 3> leaving(const Basis& basis, const Transport& transport, const Volume& travelling);

}  // namespace clpv::reference
