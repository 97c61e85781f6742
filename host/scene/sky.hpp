// SPDX-License-Identifier: MIT
// Sky: radiance from all directions, a constant or an equirectangular map. Does not depend on
// OpenCL.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace clpv {

class Fingerprint;

/// Equirectangular map: the top row is at +y, the bottom row at -y. The centre of a row is at -z,
/// its right half towards +x; `rotation` turns the map in that sense. As a light, a texel has
/// constant radiance; cameras show the map with bilinear interpolation.
struct Sky {
  int width = 1, height = 1;
  std::vector<glm::vec3> texels = {glm::vec3(0)};  ///< radiance [W/m^2/sr], row 0 first
  double rotation = 0;                             ///< [rad]
  std::vector<std::string> notes;                  ///< conversions while its file was read

  /// Index of the texel in a unit direction.
  std::size_t texel_at(const glm::dvec3& direction) const;
  glm::vec3 radiance(const glm::dvec3& direction) const { return texels[texel_at(direction)]; }
  /// Radiance with bilinear interpolation, as cameras show it.
  glm::vec3 interpolated(const glm::dvec3& direction) const;
  /// Unit direction of a point of the map: x from the left, y from the top [texels].
  glm::dvec3 direction(double x, double y) const;
  /// Solid angle of each texel in a row [sr].
  double solid_angle(int row) const;
  /// Largest value of all texels and channels.
  float max_radiance() const;
};

/// Sky with the same radiance from all directions.
Sky constant_sky(const glm::vec3& radiance);

/// Sky with one radiance above the horizon and another below.
Sky sky_with_ground(const glm::vec3& above, const glm::vec3& below);

/// Reads a map from an EXR or HDR file with channels R, G and B, times `scale`; `rotation` in
/// [rad]. Throws Error(bad_input) for other files, more than bounds::kSkyWidth x kSkyHeight pixels,
/// and values that are negative or not finite.
Sky read_sky(const std::filesystem::path& path, double scale, double rotation);

/// Adds a sky to a hash.
void add_sky(Fingerprint& print, const Sky& sky);

}  // namespace clpv
