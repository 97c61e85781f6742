// SPDX-License-Identifier: MIT
// Error of a lobe against the clamped cosine, and energy conservation of a basis, as `clpv basis`
// reports them.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "basis/rotated_lobe.hpp"
#include "basis/transport.hpp"

namespace clpv {

/// Deviation of a lobe f from the clamped cosine about d.
struct LobeQuality {
  double relative_l2;         ///< |f - max(0, w . d)| / |max(0, w . d)|, L2 norms over the sphere
  double minimum;             ///< minimum of f
  double flux;                ///< Int f dw; pi for the clamped cosine
  double peak_error_degrees;  ///< angle between the maximum of f and d
};

/// Returns |f - max(0, w . d)| / |max(0, w . d)|, L2 norms over the sphere, for f with coefficients
/// c (N).
double relative_l2(const Basis& basis, std::span<const double> c, const glm::dvec3& d);

/// Returns `count` evenly distributed unit directions on a golden spiral.
std::vector<glm::dvec3> even_directions(int count);

/// Returns the quality of coefficients c (N) as a clamped cosine about the unit vector d.
LobeQuality lobe_quality(const Basis& basis, std::span<const double> c, const glm::dvec3& d);

/// Returns the mean relative_l2 over 2000 evenly distributed axes.
double mean_relative_l2(const Basis& basis, const Lobes& lobes);

/// Returns the energy after `steps` steps of an isotropic source in free space, relative to its
/// initial energy. Nothing is clamped and there is no border, so the coefficients summed over all
/// cells obey a linear map without a grid.
double energy_after(const Basis& basis, const FaceTransport& transport, int steps);

}  // namespace clpv
