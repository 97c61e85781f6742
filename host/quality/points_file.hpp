// SPDX-License-Identifier: MIT
// Points on surfaces, from a file of comma-separated values.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

namespace clpv {

struct SurfacePoint {
  glm::dvec3 position;  ///< [m]
  glm::dvec3 normal;    ///< unit
};

/// Lines of x,y,z,nx,ny,nz; the first one may name the columns. Empty lines, and those that begin with #, are left out.
/// Normals are made unit. Throws Error(bad_input) with the line for what are not six finite numbers, coordinates beyond those
/// that scenes may have, normals without length, and more points than kMostPoints.
std::vector<SurfacePoint> read_points(const std::filesystem::path& file);

inline constexpr std::size_t kMostPoints = std::size_t{1} << 24;

}  // namespace clpv
