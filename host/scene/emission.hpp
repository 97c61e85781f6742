// SPDX-License-Identifier: MIT
// Which surfaces of a scene glow, and where on them points are put that light is sent from (kernels/emit.cl). Knows no OpenCL.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/emit.h"
#include "kernels/shared/grid.h"
#include "scene/scene.hpp"

namespace clpv {

static_assert(sizeof(ClpvEmitter) == CLPV_SIZEOF_EMITTER);

/// Whether a material gives light of its own: its front, and its back where it is double sided.
bool emits(const Material& material);

/// Whether both sides do, where one does.
bool double_sided(const Material& material);

std::array<glm::dvec3, 3> corners_of(const Scene& scene, const Triangle& triangle);

/// The triangles of such materials.
std::vector<std::uint32_t> emissive_triangles(const Scene& scene);

/// Whether there is one.
bool emits(const Scene& scene);

/// Most that all of it sends through a cell of edge `cell` [m], in the brightest channel [W]: what its brightest surface
/// sends from all of the cell's cross-section, or all there is where that is less. Textures count as white.
double most_emitted(const Scene& scene, const std::vector<std::uint32_t>& triangles, double cell);

/// Points on emissive triangles.
struct EmissionPlan {
  std::vector<ClpvEmitter> parts;
  std::uint32_t points = 0;
  int coarsened = 0;  ///< how often their distance was doubled, so that there are at most kMostEmittedPoints
};

/// Points along each edge of a cell.
inline constexpr int kEmittedPointsPerCell = 4;
inline constexpr std::uint32_t kMostEmittedPoints = 1u << 20;

/// Parts of `triangles`, which must be emissive, in and next to the grids, which are finest first: a part has
/// kEmittedPointsPerCell points a cell of the finest grid that it reaches into, and is no larger than that grid; what lies
/// beside all grids lights nothing there, and gets none. Both sides of what is double sided.
/// Throws Error(run_time) where there are more than `most` parts.
EmissionPlan plan_emission(const Scene& scene, const std::vector<std::uint32_t>& triangles,
                           const std::vector<ClpvGrid>& grids, std::uint32_t most = kMostEmittedPoints);

}  // namespace clpv
