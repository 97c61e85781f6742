// SPDX-License-Identifier: MIT
// What a camera sees of a scene, drawn on the tests' device.
#pragma once

#include "pipeline/raster/rasterize.hpp"
#include "tests/support/on_device.hpp"

namespace clpv::test {

inline SurfaceImage camera_image(const SceneData& scene, const ClpvView& view) {
  Session& session = test_session();
  Rasterizer rasterizer(session, upload_scene(session, scene));
  Surface surface = make_surface(session, view, RsmFormat::float32, true);
  rasterizer.rasterize_camera(surface);
  return read_surface(session, surface);
}

}  // namespace clpv::test
