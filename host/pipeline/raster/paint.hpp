// SPDX-License-Identifier: MIT
// Parts of an image that the host paints, since they are no light of the volumes: the sky, and the
// view `cells`.
#pragma once

#include <functional>
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

/// Irradiance [W/m^2] at points: position [m] and unit normal of each.
using IrradianceAt = std::function<std::vector<glm::vec4>(std::vector<glm::vec4> positions,
                                                          std::vector<glm::vec4> normals)>;

/// Paints the spheres of visible_spheres() with the irradiance at their cells' centres. `depth`: as
/// for visible_spheres(). `gather_offset`: distance from a point at which `irradiance_at` gathers
/// [cells].
void paint_cells(const ClpvGrid& grid, double gather_offset, const IrradianceAt& irradiance_at,
                 const ClpvView& view, const std::vector<float>& depth, std::vector<float>& image);

}  // namespace clpv
