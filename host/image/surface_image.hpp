// SPDX-License-Identifier: MIT
// RSM or G-buffer on the host. Does not depend on OpenCL.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/view.h"

namespace clpv {

/// Unit normal of the triangle of a camera's pixel, from its stored normal
/// (kernels/shared/normal.h).
glm::dvec3 geometric_normal(const glm::vec4& normal);
/// Normal along which lookups in volumes and origins of rays are lifted.
glm::dvec3 lift_normal(const glm::vec4& normal);
glm::dvec3 lift_normal(const glm::dvec3& shading, const glm::dvec3& geometric);
/// Stored normal with these unit vectors.
glm::vec4 stored_normal(const glm::dvec3& shading, const glm::dvec3& geometric);

/// Host copy of a Surface (pipeline/raster/surface.hpp), input of the CPU reference. One value per
/// pixel, row 0 first. Depth [m] is along the view's forward axis, 0 without a surface; normals and
/// colours are as in Surface.
struct SurfaceImage {
  ClpvView view{};
  std::vector<float> depth;
  std::vector<glm::vec4> normal, colour, emissive;  ///< xyz; w: geometric_normal(), else unused
  std::vector<glm::vec4> position = {};  ///< [m], in place of depth for points without a view
};

}  // namespace clpv
