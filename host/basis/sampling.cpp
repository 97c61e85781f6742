// SPDX-License-Identifier: MIT
#include "basis/sampling.hpp"

#include <cmath>
#include <numbers>

#include "kernels/shared/pixel_planes.h"

namespace clpv {
namespace {

constexpr std::uint64_t kNearSeed = 1;

/// Order of the pixels of a tile, by which neighbours get directions far from each other (ordered
/// dither).
constexpr unsigned kTileOrder[CLPV_PLANE_TILE * CLPV_PLANE_TILE] = {0, 8,  2, 10, 12, 4, 14, 6,
                                                                    3, 11, 1, 9,  15, 7, 13, 5};

}  // namespace

std::vector<std::vector<glm::vec3>> near_directions(int rays) {
  std::vector<std::vector<glm::vec3>> directions;
  for (const unsigned order : kTileOrder) {
    std::vector<glm::vec3>& pixel = directions.emplace_back();
    for (int ray = 0; ray < rays; ++ray)
      pixel.emplace_back(
          cosine_direction({0, 0, 1}, sobol_point(order * rays + ray, mix(kNearSeed))));
  }
  return directions;
}

double near_cone(int rays) {
  return std::sqrt(2 * std::numbers::pi / (CLPV_PLANE_TILE * CLPV_PLANE_TILE * rays));
}

}  // namespace clpv
