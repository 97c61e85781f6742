// SPDX-License-Identifier: MIT
// CPU reference of stage `inject` (kernels/inject/light.cl and surfels.cl), in double: light and
// surfels of an RSM or G-buffer into volumes (docs/method.md, 'Injection', 'Blockers').
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "image/image.hpp"
#include "kernels/shared/grid.h"
#include "options/stage_options.hpp"
#include "reference/volume.hpp"
#include "scene/emission.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

/// Adds the virtual point lights of `rsm` to `light` (grid.n^3 cells, 3 channels): c += (P / pi)
/// c(n) in each light's cell. `occluded`: bits of visibility_masks(), or null.
void inject_light(const SurfaceImage& rsm, const ClpvGrid& grid, const Basis& basis,
                  const InjectOptions& options, const std::uint8_t* occluded, Volume& light);

/// Merges the surfels of `surface` into `geometry` (grid.n + 1 samples along each axis, 1 channel).
/// Uses every `stride`-th pixel along each axis, the middle one of stride^2, with stride^2 times
/// the area.
void inject_geometry(const SurfaceImage& surface, const ClpvGrid& grid, const Basis& basis,
                     const InjectOptions& options, Volume& geometry, int stride = 1);

/// Merges the blockers `found` of one source into `geometry`: each sample keeps the function of
/// higher energy, or the larger areas.
void merge_geometry(const Volume& found, const Basis& basis, Blocking blocking, Volume& geometry);

/// Merges `a` and `b`, but chooses the function of lower energy where energies differ by rounding
/// only. merge_geometry() and this function bound the result of a device.
Volume merged_against_ties(const Volume& a, const Volume& b, const Basis& basis, Blocking blocking);

/// Returns the position of a pixel's surface in cells from the grid's origin.
glm::dvec3 grid_point(const SurfaceImage& surface, std::size_t pixel, const ClpvGrid& grid);

/// Returns where a pixel's virtual point light lies. `in_front`: InjectOptions.
glm::dvec3 light_point(const SurfaceImage& surface, std::size_t pixel, const ClpvGrid& grid,
                       bool in_front);

/// Returns the nearest cell to `point` [cells] of those that all eight sample points about it see,
/// in a grid of n^3 cells; nothing if there is none.
std::optional<glm::ivec3> nearest_in_sight(const glm::dvec3& point, int n,
                                           const std::uint8_t* occluded);

// CPU reference of stage `emit` (kernels/inject/emit.cl): virtual point lights of emissive
// triangles, in double (docs/method.md, 'Emissive surfaces').

/// A virtual point light. Its flux is P = pi L A.
struct EmittedPoint {
  glm::dvec3 position{0};
  glm::dvec3 normal{0};  ///< unit, on the emitting side; 0 for a triangle without area
  glm::dvec3 flux{0};    ///< [W]
  double tolerance = 0;  ///< flux of samples close to a masked material's alpha cutoff [W]
};

/// Returns the points of `plan` in order.
std::vector<EmittedPoint> emit(const SceneData& scene, const EmissionPlan& plan);

}  // namespace clpv::reference
