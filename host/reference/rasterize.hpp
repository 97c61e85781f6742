// SPDX-License-Identifier: MIT
// CPU reference of stage `rasterize`, in double: tests every pixel against every triangle
// (docs/method.md, 'Rasterize').
#pragma once

#include <vector>

#include "image/image.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

/// Image of the CPU reference, and the pixels where rounding may change it.
struct RasterizedImage {
  SurfaceImage image;
  /// Pixels whose result depends on rounding. They have an edge within 1/64 pixel of the centre,
  /// two surfaces within 1e-5 of their depth, alpha within 1e-3 of its cutoff, or a surface seen
  /// edge-on.
  std::vector<bool> uncertain;
};

/// Returns the G-buffer of a view by the rules of pipeline/raster/rasterize.hpp: corners snapped to
/// 1/256 pixel, top-left rule, perspective-correct attributes, nearest surface. The first triangle
/// of equal depth wins.
RasterizedImage rasterize_camera(const SceneData& scene, const ClpvView& view);
/// Returns the RSM of a view. `colour` is the flux [W] of each texel's virtual point light; format
/// float32.
RasterizedImage rasterize_rsm(const SceneData& scene, const ClpvLight& light, const ClpvView& view);

}  // namespace clpv::reference
