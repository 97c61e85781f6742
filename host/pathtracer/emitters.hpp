// SPDX-License-Identifier: MIT
// Points on emissive triangles, and directions of a sky, for paths that look for light.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "reference/materials.hpp"
#include "scene/scene.hpp"
#include "scene/sky.hpp"

namespace clpv::reference {

/// A point that was picked.
struct EmitterPoint {
  SurfacePoint point;
  glm::vec3 position{0};
  double density = 0;  ///< of picking it, on its area [1/m^2]
};

/// The triangles of a scene that emit, each picked by about what it sends out, and its points evenly by area.
/// Borrows what it is made of.
class Emitters {
 public:
  Emitters(const Scene& scene, const Materials& materials);

  bool none() const { return triangles_.empty(); }

  /// The point that a point of [0, 1)^2 stands for. Not where there are none.
  EmitterPoint pick(glm::dvec2 at) const;

  /// With which density pick() finds a triangle's points; 0 where it does not emit.
  double density(std::uint32_t triangle) const { return none() ? 0 : densities_[triangle]; }

  /// The unit normal of a triangle's front. Of one with an area.
  glm::dvec3 front(std::uint32_t triangle) const;

  /// What a point sends towards the side that `towards` is on [W/m^2/sr].
  glm::dvec3 radiance(const SurfacePoint& point, const glm::dvec3& towards) const;

 private:
  const Scene& scene_;
  const Materials& materials_;
  std::vector<std::uint32_t> triangles_;
  std::vector<double> upto_;       ///< of all that is sent, the share of those up to each
  std::vector<double> densities_;  ///< of all the scene's triangles
};

/// A direction that was picked, and what shines from it.
struct SkyDirection {
  glm::dvec3 direction{0}, radiance{0};
  double density = 0;  ///< of picking it [1/sr]
};

/// Picks a sky's texels by what they send, in the brightest channel. Borrows the sky.
class SkySampler {
 public:
  /// Null: there is none.
  explicit SkySampler(const Sky* sky);

  /// Where there is none, or it is black.
  bool none() const { return upto_row_.empty(); }

  SkyDirection pick(const glm::dvec2& at) const;
  double density(const glm::dvec3& direction) const;
  glm::dvec3 radiance(const glm::dvec3& direction) const { return glm::dvec3(sky_->radiance(direction)); }
  glm::vec3 seen(const glm::dvec3& direction) const { return sky_->seen(direction); }

 private:
  double weight(std::size_t texel) const;

  const Sky* sky_;
  std::vector<double> upto_row_;     ///< share of all that is sent up to each row's end
  std::vector<double> upto_column_;  ///< of what a row sends, up to each of its texels' end
  double all_ = 0;
};

}  // namespace clpv::reference
