// SPDX-License-Identifier: MIT
// Reader of surface points from a CSV file.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

namespace clpv {

struct SurfacePoint {
  glm::dvec3 position;  ///< [m]
  glm::dvec3 normal;    ///< unit
};

/// Reads lines of x,y,z,nx,ny,nz with an optional header line. Skips empty lines and lines that
/// begin with #. Normalises the normals. Throws Error(bad_input) with the line number for invalid
/// numbers, coordinates outside the range of scenes, normals without length, and more points than
/// kMaxPoints.
std::vector<SurfacePoint> read_points(const std::filesystem::path& file);

inline constexpr std::size_t kMaxPoints = std::size_t{1} << 24;

}  // namespace clpv
