// SPDX-License-Identifier: MIT
// What shines from beyond a scene, from all directions: a constant or an equirectangular map. Knows no OpenCL.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace clpv {

class Fingerprint;

/// A map of the sphere round y: row 0 touches +y, the last one -y. The middle of a row looks along -z, and what is right of
/// it towards +x; `rotation` turns it all that way.
///
/// As light, each texel shines evenly, so that what it sends is its radiance times its solid angle. Looked at, it is
/// bilinear between texels.
struct Sky {
  int width = 1, height = 1;
  std::vector<glm::vec3> texels = {glm::vec3(0)};  ///< radiance [W/m^2/sr], row 0 first
  double rotation = 0;                             ///< [rad]

  /// The texel that shines from a unit direction.
  std::size_t texel_at(const glm::dvec3& direction) const;
  glm::vec3 radiance(const glm::dvec3& direction) const { return texels[texel_at(direction)]; }
  /// As it is seen.
  glm::vec3 seen(const glm::dvec3& direction) const;
  /// The direction that a point of the map shines from: x from the left, y from the top, in texels.
  glm::dvec3 direction(double x, double y) const;
  /// Of each texel of a row [sr].
  double solid_angle(int row) const;
  /// In any channel, anywhere.
  float brightest() const;
};

/// The same from everywhere.
Sky even_sky(const glm::vec3& radiance);

/// One above the horizon, another below.
Sky parted_sky(const glm::vec3& above, const glm::vec3& below);

/// Reads a map, an EXR or HDR file that has R, G and B, times `scale`. Throws Error(bad_input) for what is no such file, is
/// larger than bounds::kSkyWidth x kSkyHeight, or holds what is negative or not finite: that names pixel and channel.
Sky read_sky(const std::filesystem::path& path, double scale, double rotation);

void add_sky(Fingerprint& print, const Sky& sky);

}  // namespace clpv
