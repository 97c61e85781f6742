// SPDX-License-Identifier: MIT
// How well a lobe stands for the clamped cosine, and how a basis keeps energy: what `clpv basis` tells.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "basis/rotated_lobe.hpp"
#include "basis/transport.hpp"

namespace clpv {

struct LobeQuality {
  double relative_l2;         ///< |f - max(0, w . d)| / |max(0, w . d)|, L2 norms over the sphere
  double minimum;             ///< least f(w)
  double flux;                ///< Int f dw; of the clamped cosine pi
  double peak_error_degrees;  ///< between the direction of the largest f and d
};

/// Of the coefficients c as a clamped cosine along the unit vector d.
LobeQuality lobe_quality(const Basis& basis, std::span<const double> c, const glm::dvec3& d);

/// The mean of that error over 2000 axes, spread evenly on a golden spiral.
double mean_relative_l2(const Basis& basis, const Lobes& lobes);

/// Energy after that many steps of an isotropic source in free space, over what it was; nothing clamped, and
/// no border. Total coefficients obey a linear map, so there is no grid.
double energy_after(const Basis& basis, const FaceTransport& transport, int steps);

}  // namespace clpv
