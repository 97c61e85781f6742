// SPDX-License-Identifier: MIT
// Baseline: radiance cascades in world space (Sannikov, 'Radiance Cascades: A Novel Approach to Calculating Global
// Illumination', 2023), on the CPU with Embree. One bounce, without history.
//
// Probes of cascade i have 2^i times the spacing of cascade 0, 4^i times its directions, and intervals that are ratio^i times
// as long and begin where those of cascade i - 1 end. Merging, from the coarsest cascade down: what passes an interval
// unblocked takes the mean radiance of the four directions within its own, trilinearly between the eight probes of the next
// cascade. With the bilinear fix a ray goes to the start of the interval of each of these eight probes, in place of one
// straight on: what blocks one of them does not block the others.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <unordered_map>
#include <vector>

#include "baselines/view.hpp"
#include "kernels/shared/grid.h"

namespace clpv::baselines {

struct RadianceCascadeSettings {
  unsigned side = 1;         ///< cascade 0 has 12 side^2 directions
  float spacing = 1;         ///< of cascade 0 [cells]
  float first = 1;           ///< length of the intervals of cascade 0 [its spacing]
  float ratio = 2;           ///< of the lengths of intervals from cascade to cascade
  unsigned cascades = 5;     ///< the last one's intervals have no end
  bool bilinear_fix = true;  ///< eight rays for each direction in place of one
  bool visibility = true;    ///< pixels take only probes that they see, by a ray each
};

/// Directions of the pixels of HEALPix with `side`^2 in each of its 12 faces, of equal solid angles (Gorski et al., 'HEALPix',
/// The Astrophysical Journal 622, 2005).
std::vector<glm::vec3> healpix_directions(unsigned side);

/// Cascades over one grid, for the pixels that are not 0 in `pixels`. Only probes that these need are traced.
class RadianceCascades {
 public:
  RadianceCascades(const View& view, const glm::vec3& origin, float cell, std::vector<char> pixels,
                   const RadianceCascadeSettings& settings);

  void render(Irradiance& image);
  std::size_t bytes() const;  ///< of radiance
  std::size_t probes() const { return cascades_[0].probes.size(); }

  /// Index of the direction `which` (0 to 3) of 2 side within a direction of `side`.
  static std::size_t child(std::size_t direction, unsigned side, unsigned which);

 private:
  struct Cascade {
    float cell;  ///< spacing of probes [m], at the centres of cells
    unsigned side;
    float from, to;  ///< interval [m]
    std::vector<glm::ivec3> probes = {};
    std::unordered_map<std::uint64_t, std::size_t> index = {};  ///< of probes by cell
    std::vector<glm::vec3> radiance = {};                       ///< of each probe, by direction
  };
  glm::vec3 centre(const Cascade& cascade, const glm::ivec3& cell) const;
  glm::vec3 pixel_in_cells(std::size_t pixel) const;
  void find_probes();
  glm::vec3 children_of(const Cascade& next, std::size_t probe, std::size_t direction) const;
  void trace(Cascade& cascade, const Cascade* next);
  glm::vec3 sample(std::size_t pixel, const std::vector<glm::vec3>& directions) const;

  const View& view_;
  glm::vec3 origin_;
  std::vector<char> pixels_;
  RadianceCascadeSettings settings_;
  std::vector<Cascade> cascades_;
};

struct CascadedImage {
  Irradiance irradiance;
  std::size_t bytes = 0, probes = 0;  ///< of radiance; of cascade 0
};

/// Irradiance by radiance cascades over the finest grid that encloses each pixel; 0 beyond all grids.
CascadedImage radiance_cascades(const View& view, const std::vector<ClpvGrid>& grids,
                                const RadianceCascadeSettings& settings);

}  // namespace clpv::baselines
