// SPDX-License-Identifier: MIT
#include "pipeline/light_scale.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/light_kind.hpp"

namespace clpv {
namespace {

constexpr double kFull = 256;         // [W/sr] of a full cell, stored
constexpr double kMostDoubling = 60;  // of a light so weak that floats end first

/// The most that a light sends through a cell [W].
double most_flux(const ClpvLight& light, double cell) {
  const double brightest = *std::max_element(light.intensity, light.intensity + 3);
  switch (kind_of(light)) {
    case LightKind::directional:
      return brightest * (cell * cell);
    case LightKind::spot:
    case LightKind::point:
      break;
  }
  return brightest * (4 * std::numbers::pi);
}

}  // namespace

float light_scale(const VolumeFormat& format, const std::vector<ClpvLight>& lights, float coarsest_cell,
                  double other) {
  double flux = other;
  for (const ClpvLight& light : lights) flux += most_flux(light, static_cast<double>(coarsest_cell));
  if (format.storage != Storage::float16 || !(flux > 0)) return 1;
  const double doublings = std::floor(std::log2(kFull * std::numbers::pi / flux));
  return static_cast<float>(std::exp2(std::clamp(doublings, -kMostDoubling, kMostDoubling)));
}

ClpvLight scaled(ClpvLight light, float scale) {
  for (float& component : light.intensity) component *= scale;
  return light;
}

}  // namespace clpv
