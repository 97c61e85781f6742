// SPDX-License-Identifier: MIT
// Matrices between light in 24 direction bins and flux on a cell's six faces (docs/method.md, 'More
// bounces'). In double, without OpenCL.
#pragma once

#include "basis/basis.hpp"
#include "basis/matrix.hpp"

namespace clpv {

/// Faces of a cell by outward normal: +x, -x, +y, -y, +z, -z.
inline constexpr int kCellFaces = 6;

/// Sweeps for all bounces in a medium that scatters, along 24 directions.
inline constexpr int kScatteredSweeps = 8;

/// Limit of the ratio of successive bounces in the series of `--bounces all`, which diverges in
/// closed white rooms.
inline constexpr double kMaxReturned = 0.98;

/// 6 x 24: incident flux [W] on each face of a cell from a sweep's bins (radiance times s^2):
/// Omega_b max(0, -w_b . a). It equals the flux that a sweep along 24 directions carries between
/// planes.
Matrix incident_flux();

/// N x 6: coefficients [W/sr] of the light that a face emits per flux [W]: the projected clamped
/// cosine about its normal, divided by its integral. Conserves the flux.
Matrix reflected_intensity(const Basis& basis);

/// Share of a face's incident flux that incident_flux() counts twice at the edge to one adjacent
/// face, for isotropic light on two fully covered faces. A sweep carries light through an edge
/// once; both faces count it.
double edge_loss();

}  // namespace clpv
