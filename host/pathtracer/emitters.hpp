// SPDX-License-Identifier: MIT
// Sampling of points on emissive triangles and of directions of a sky (next event estimation).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "reference/materials.hpp"
#include "scene/scene.hpp"
#include "scene/sky.hpp"

namespace clpv::pathtracer {

/// A sampled point.
struct EmitterSample {
  reference::SurfacePoint point;
  glm::vec3 position{0};  ///< [m]
  double density = 0;     ///< probability density over area [1/m^2]
};

/// Distribution over the emissive triangles of a scene: a triangle's probability is proportional to
/// its approximate power, and its points have constant density over area. Borrows the scene and the
/// materials.
class Emitters {
 public:
  Emitters(const SceneData& scene, const reference::Materials& materials);

  /// Returns true if no triangle emits.
  bool empty() const { return triangles_.empty(); }

  /// Maps a point of [0, 1)^2 to a point on a triangle. Not for empty distributions.
  EmitterSample sample(glm::dvec2 random) const;

  /// Density of sample() on a triangle [1/m^2]; 0 if the triangle does not emit.
  double density(std::uint32_t triangle) const { return empty() ? 0 : densities_[triangle]; }

  /// Unit normal of a triangle's front. The triangle's area must not be 0.
  glm::dvec3 front_normal(std::uint32_t triangle) const;

  /// Radiance that a point emits to the side of direction `towards` [W/m^2/sr].
  glm::dvec3 radiance(const reference::SurfacePoint& point, const glm::dvec3& towards) const;

 private:
  const SceneData& scene_;
  const reference::Materials& materials_;
  std::vector<std::uint32_t> triangles_;
  std::vector<double> cdf_;        ///< cumulative probability of triangles_
  std::vector<double> densities_;  ///< one per triangle of the scene [1/m^2]
};

/// A sampled direction and the radiance from it.
struct SkySample {
  glm::dvec3 direction{0}, radiance{0};  ///< unit vector, towards the sky; [W/m^2/sr]
  double density = 0;                    ///< probability density over solid angle [1/sr]
};

/// Distribution over a sky's texels: density proportional to the radiance of the brightest channel.
/// Borrows the sky.
class SkySampler {
 public:
  /// `sky` may be null.
  explicit SkySampler(const Sky* sky);

  /// Returns true without a sky, or for a black one. Then sample(), density() and radiance() must
  /// not be called.
  bool empty() const { return row_cdf_.empty(); }

  /// Maps a point of [0, 1)^2 to a direction.
  SkySample sample(const glm::dvec2& random) const;
  /// Density of sample() in a unit direction [1/sr].
  double density(const glm::dvec3& direction) const;
  /// Radiance of the texel in a direction [W/m^2/sr].
  glm::dvec3 radiance(const glm::dvec3& direction) const {
    return glm::dvec3(sky_->radiance(direction));
  }
  /// Radiance interpolated between texels, as cameras show it [W/m^2/sr]. Needs a sky.
  glm::vec3 interpolated(const glm::dvec3& direction) const {
    return sky_->interpolated(direction);
  }

 private:
  double weight(std::size_t texel) const;

  const Sky* sky_;
  std::vector<double> row_cdf_;      ///< cumulative probability of rows
  std::vector<double> column_cdfs_;  ///< cumulative probability of a row's texels, row by row
  double total_ = 0;                 ///< integral of weight over the sphere
};

}  // namespace clpv::pathtracer
