// SPDX-License-Identifier: MIT
// Emissive triangles of a scene, and the points on them that kernels/inject/emit.cl injects. Does
// not depend on OpenCL.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/emit.h"
#include "kernels/shared/grid.h"
#include "scene/scene.hpp"

namespace clpv {

/// Returns true for an emissive material. Its front emits, and also its back if it is double sided.
bool emits(const ClpvMaterial& material);

/// Returns true for a double-sided material.
bool double_sided(const ClpvMaterial& material);

/// Corners of a triangle [m].
std::array<glm::dvec3, 3> corners_of(const SceneData& scene, const Triangle& triangle);

/// Indices of the triangles with emissive materials.
std::vector<std::uint32_t> emissive_triangles(const SceneData& scene);

/// Returns true if a triangle of the scene emits.
bool emits(const SceneData& scene);

/// Upper bound of the emitted flux through a cell of edge `cell` [m], in the brightest channel [W]:
/// min(flux of all triangles, largest exitance times cell^2). Textures count as white.
double max_emitted_flux(const SceneData& scene, const std::vector<std::uint32_t>& triangles,
                        double cell);

/// Points on emissive triangles.
struct EmissionPlan {
  std::vector<ClpvEmitter> parts;  ///< parts of triangles, each with a regular pattern of points
  std::uint32_t points = 0;
  int coarsened = 0;  ///< number of doublings of the points' distance, to stay within the maximum
};

/// Points along each edge of a cell.
inline constexpr int kEmittedPointsPerCell = 4;
inline constexpr std::uint32_t kMaxEmittedPoints = 1u << 20;

/// Distributes points on the emissive `triangles`. `grids` are sorted from fine to coarse. A part
/// has kEmittedPointsPerCell points per cell edge of the finest grid that it reaches, and is at
/// most as large as that grid; parts outside all grids are omitted. Double-sided triangles have
/// parts on both sides. Throws Error(run_time) for more than `max_count` parts.
EmissionPlan plan_emission(const SceneData& scene, const std::vector<std::uint32_t>& triangles,
                           const std::vector<ClpvGrid>& grids,
                           std::uint32_t max_count = kMaxEmittedPoints);

}  // namespace clpv
