// SPDX-License-Identifier: MIT
// Parts of an image that the host paints, since they are no light of the volumes: the sky, and the
// view `cells`.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "kernels/shared/grid.h"
#include "kernels/shared/light.h"
#include "kernels/shared/view.h"
#include "scene/sky.hpp"

namespace clpv {

/// Adds the sky's radiance, seen through the medium, to pixels of an RGBA image without alpha, and
/// sets their alpha to 1.
void paint_sky(const Sky& sky, const std::optional<ClpvMedium>& medium, const ClpvView& view,
               std::vector<float>& image);

// View `cells`: the cells of the finest cascade as small spheres, each shaded by the irradiance
// that its light gives surfaces of every direction, as in views of light probes.

constexpr double kSphereRadius = 0.2;  // [cells]

/// Visible points of the spheres: pixel, centre of the cell [m], and unit normal of the sphere
/// there.
struct CellSpheres {
  std::vector<std::size_t> pixels;
  std::vector<glm::dvec3> centres, normals;
};

/// Finds the first sphere before the surface in each pixel of a perspective view. `depth` [m], row
/// 0 first; 0 without a surface. The cells next to the eye have no sphere, since it would cover the
/// view.
CellSpheres visible_spheres(const ClpvView& view, const std::vector<float>& depth,
                            const ClpvGrid& grid);

/// Irradiance [W/m^2] at points: position [m] and unit normal of each.
using IrradianceAt = std::function<std::vector<glm::vec4>(std::vector<glm::vec4> positions,
                                                          std::vector<glm::vec4> normals)>;

/// Paints the spheres of visible_spheres() with the irradiance at their cells' centres. `depth`: as
/// for visible_spheres(). `gather_offset`: distance from a point at which `irradiance_at` gathers
/// [cells].
void paint_cells(const ClpvGrid& grid, double gather_offset, const IrradianceAt& irradiance_at,
                 const ClpvView& view, const std::vector<float>& depth, std::vector<float>& image);

}  // namespace clpv
