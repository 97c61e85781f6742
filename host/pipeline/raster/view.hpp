// SPDX-License-Identifier: MIT
// Views of a frame: the camera's, and those of lights for reflective shadow maps and shadow maps.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "kernels/shared/grid.h"
#include "kernels/shared/light.h"
#include "kernels/shared/raster.h"
#include "kernels/shared/view.h"
#include "pipeline/raster/triangle_clusters.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Largest outer half-angle [rad] of a spot light with a single perspective view. Beyond it the
/// outer texels grow without limit (tan), and the light uses the six views of a point light.
inline constexpr double kWidestSpotView = 1.0472;  // 60 degrees

/// Returns the camera's view of `width` x `height` square pixels. It has no far plane.
ClpvView camera_view(const SceneCamera& camera, int width, int height);

/// Where a box lies in a view: `outside` if surely beyond one of its borders, `inside` if surely
/// beyond the near plane and inside the rasteriser's guard band.
enum class BoxPlace : unsigned char { outside, inside, clipped };
/// Returns the places of all boxes, with a margin for rounding.
std::vector<BoxPlace> places_of(const ClpvView& view, const Boxes& boxes);

/// Places a triangle cluster in an orthographic view, with margins for rounding.
ClpvViewCluster place_cluster(const ClpvView& view, const Boxes& boxes, unsigned number);

/// Returns a directional light's orthographic view of a cascade, with `size` texels along each
/// side. It covers the cascade's cube plus half a cell, since virtual point lights move by as much,
/// for any direction of the light. Texels form a lattice that is fixed in the world, in the plane
/// across the light. While light, cascade size and `size` are constant, a moved cascade moves its
/// window by whole texels. Depths start before `bounds`, so that all surfaces between light and
/// cascade cast shadows.
ClpvView directional_rsm_view(const ClpvLight& light, const ClpvGrid& cascade, const Bounds& bounds,
                              int size);

/// Returns a spot light's perspective view, which covers its cone. Requires an outer half-angle up
/// to kWidestSpotView.
ClpvView spot_view(const ClpvLight& light, int size, const Bounds& bounds);

/// Returns six square views from the light along +x, -x, +y, -y, +z, -z, which together cover every
/// direction once.
std::vector<ClpvView> point_views(const ClpvLight& light, int size, const Bounds& bounds);

/// Bounds that a directional light's shadow map and its RSMs are made for.
struct LightBounds {
  Bounds shadows, rsms;
};

/// Returns the bounds for cascades of which `coarsest` is the largest: `all`, the bounds of
/// `vertices`, unless surfaces lie behind a gap. Seen from the cascade's middle, a gap spans
/// distances from 2^k to 2^(k+3) times half its edge without a vertex; a far triangle then does not
/// coarsen shadows. Surfaces left out still cast shadows. Bounds of RSMs then cover the cascade,
/// too: surfaces before them are clamped to the near plane, and their virtual point lights must lie
/// outside.
LightBounds light_bounds(const std::vector<Vertex>& vertices, const Bounds& all,
                         const ClpvGrid& coarsest);

/// Returns true if a light has its own reflective shadow maps per cascade. A directional light has;
/// other lights use views of all surfaces that they light.
bool rsm_follows_cascade(const ClpvLight& light);

/// Returns the views of a light's reflective shadow maps for one cascade. A directional light or a
/// spot light has one view. A point light, or a spot light wider than kWidestSpotView, has six.
std::vector<ClpvView> rsm_views(const ClpvLight& light, const ClpvGrid& cascade,
                                const Bounds& bounds, int size);

/// Returns the views of a light's shadow maps of the whole scene: one or six, as rsm_views().
std::vector<ClpvView> shadow_views(const ClpvLight& light, const Bounds& bounds, int size);

}  // namespace clpv
