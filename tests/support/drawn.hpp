// SPDX-License-Identifier: MIT
// Surfaces that the rasteriser sees.
#pragma once

#include "pipeline/raster/rasterize.hpp"
#include "tests/support/on_device.hpp"

namespace clpv::test {

inline SurfaceImage drawn(Rasterizer& rasterizer, const ClpvView& view) {
  Surface surface = make_surface(test_session(), view, RsmFormat::float32, true);
  rasterizer.rasterize_camera(surface);
  return read_surface(test_session(), surface);
}
inline SurfaceImage drawn(const SceneData& scene, const ClpvView& view) {
  Rasterizer rasterizer(test_session(), upload_scene(test_session(), scene));
  return drawn(rasterizer, view);
}

}  // namespace clpv::test
