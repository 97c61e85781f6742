// SPDX-License-Identifier: MIT
// The views a frame is rasterised from: the camera's, and a light's for reflective shadow maps and shadow
// maps.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/grid.h"
#include "kernels/shared/light.h"
#include "kernels/shared/view.h"
#include "scene/scene.hpp"

namespace clpv {

static_assert(sizeof(ClpvView) == CLPV_SIZEOF_VIEW && sizeof(ClpvGrid) == CLPV_SIZEOF_GRID);

/// Outer half-angle [rad] up to which a spot light is looked at through one perspective view; beyond it the
/// outer texels grow without limit (tan), and it takes the six views of a point light.
inline constexpr double kWidestSpotView = 1.0472;  // 60 degrees

/// What the camera sees, `width` x `height` pixels, square ones. Nothing is too far to be seen.
ClpvView camera_view(const Camera& camera, int width, int height);

/// False only where nothing in `bounds` is in sight, by a margin for rounding: all of it is outside one of the view's borders.
bool may_be_in_sight(const ClpvView& view, const Bounds& bounds);

/// A directional light's orthographic view of a cascade, `size` texels along each side. It covers the
/// cascade's cube and half a cell round it (virtual point lights move by as much), for any direction of the
/// light. The texels are those of a lattice fixed in the world, in the plane across the light: as long as
/// light, cascade size and `size` stay, a moved cascade sees the same texels through a window moved by whole
/// texels. Depths start before `bounds`, so that what stands between light and cascade casts its shadow,
/// wherever it is.
ClpvView directional_rsm_view(const ClpvLight& light, const ClpvGrid& cascade, const Bounds& bounds,
                              int size);

/// A spot light's perspective view of all its cone lights. Requires an outer half-angle up to
/// kWidestSpotView.
ClpvView spot_view(const ClpvLight& light, int size, const Bounds& bounds);

/// Six square views from the light along +x, -x, +y, -y, +z, -z that together see every direction once.
std::vector<ClpvView> point_views(const ClpvLight& light, int size, const Bounds& bounds);

/// Whether a light's reflective shadow maps differ from cascade to cascade: a directional light's do; others see all they
/// light from where they stand.
bool rsm_follows_cascade(const ClpvLight& light);

/// The views to make a light's reflective shadow maps of one cascade from: one for a directional light and
/// for a spot light, six for a point light and for a spot light wider than kWidestSpotView.
std::vector<ClpvView> rsm_views(const ClpvLight& light, const ClpvGrid& cascade, const Bounds& bounds,
                                int size);

/// The views to make a light's shadow maps from, of the whole scene: one, one or six, as for rsm_views().
std::vector<ClpvView> shadow_views(const ClpvLight& light, const Bounds& bounds, int size);

}  // namespace clpv
