// SPDX-License-Identifier: MIT
// Matrices between light in 24 direction bins and flux on a cell's six faces (docs/method.md, 'More
// bounces'). In double, without OpenCL.
#pragma once

#include <algorithm>

#include "basis/basis.hpp"
#include "basis/matrix.hpp"

namespace clpv {

/// Faces of a cell by outward normal: +x, -x, +y, -y, +z, -z.
inline constexpr int kCellFaces = 6;

/// Sweeps for all bounces in a medium that scatters.
inline constexpr int kScatteredSweeps = 8;

/// Sweeps for all bounces without such a medium before the last one: default
/// and least number. Further ones carry light farther from where it arrived (docs/method.md, 'More
/// bounces').
inline constexpr int kSeriesSweeps = 3, kLeastSeriesSweeps = 2;

/// Limit of the ratio of successive bounces in the series of `--bounces all`, which diverges in
/// closed white rooms.
inline constexpr double kMaxReturned = 0.98;

/// Share of that ratio q by which the first of three and more sweeps' light is relaxed. Light that
/// decays by l from bounce to bounce has the error l^n (l - 2 q / 3) (l - q) / ((1 - 2 q / 3)
/// (1 - q)): with q = 0.8 and n = 2 below 0.12 for all l up to q, without the second factor 0.22.
inline constexpr double kRelaxation = 2. / 3;

/// 6 x 24: incident flux [W] on each face of a cell from a sweep's bins (radiance times s^2):
/// Omega_b max(0, -w_b . a), scaled so that even light of radiance 1 has pi.
Matrix incident_flux();

/// N x 6: coefficients [W/sr] of the light that a face emits per flux [W]: the projected clamped
/// cosine about its normal, divided by its integral. Conserves the flux.
Matrix reflected_intensity(const Basis& basis);

/// Light F of a white furnace, over that of even light 1, below which few of its surfaces are in
/// sight, so that it says little.
inline constexpr double kLeastWhite = 0.02;

/// Radiance of a white border above which a direction counts as open: walls let less through.
inline constexpr double kLeastOpen = 0.1;

/// Limit of a furnace's radiance where all surfaces block light: none.
inline constexpr double kNoLimitOfWhite = 1e30;

/// Number that swept light is divided by: F, below kLeastWhite a number that rises to 1, so that
/// light where the furnace is dark stays as it is.
inline double over_furnace(double f) {
  return f >= kLeastWhite ? f : 1 - (1 / kLeastWhite - 1) * std::max(f, 0.0);
}

/// Least share |n_a| / (|n_x| + |n_y| + |n_z|) of the axis nearest to a normal, 1 / sqrt(3),
/// halved.
inline constexpr double kLeastShare = 0.29;

}  // namespace clpv
