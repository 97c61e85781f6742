// SPDX-License-Identifier: MIT
// Directions of a sky, for paths that look for light.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/sky.hpp"

namespace clpv::reference {

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
