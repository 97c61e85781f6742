// SPDX-License-Identifier: MIT
// What a view sees of a scene, by brute force in double: the CPU reference of the rasteriser.
#pragma once

#include <vector>

#include "image/surface_image.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

/// A CPU reference's surface, and where rounding may decide otherwise.
struct Rasterized {
  SurfaceImage image;
  /// Pixels where a hair's breadth decides what they see: an edge within 1/64 pixel of their centre, two surfaces
  /// within 1e-5 of their depth, a texel's alpha within 1e-3 of its cutoff, a surface seen edge-on.
  std::vector<bool> doubtful;
};

/// The rasteriser's rules (pipeline/rasterize.hpp), every pixel against every triangle: corners snapped to 1/256
/// pixel, the top-left rule, perspective-correct values, the nearest surface and of equals the first.
Rasterized rasterize_camera(const Scene& scene, const ClpvView& view);
/// `colour` is the flux [W] of each texel's virtual point light; format float32.
Rasterized rasterize_rsm(const Scene& scene, const ClpvLight& light, const ClpvView& view);

}  // namespace clpv::reference
