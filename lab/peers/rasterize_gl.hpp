// SPDX-License-Identifier: MIT
// Rasterising passes by OpenGL ES 3.2 without a window (EGL), for comparison with the OpenCL
// rasteriser: with the same views, triangles, materials and formats. Mesa's llvmpipe runs it on
// machines without a GPU.
#pragma once

#include <memory>
#include <vector>

#include "kernels/shared/light.h"
#include "kernels/shared/view.h"
#include "options/stages.hpp"
#include "scene/scene.hpp"

namespace clpv::bench {

/// Reason why OpenGL ES is unavailable; empty if it is available.
std::string gl_missing();

class GlRasterizer {
 public:
  /// `pass`: rasterize_camera (depth, normal, albedo), rasterize_shadow (depth) or rasterize_rsm
  /// (depth, normal, flux). Depth is a float, the others four floats. All `views` have one size.
  /// Throws Error(device) if gl_missing() is not empty, Error(run_time) if the driver fails.
  GlRasterizer(const SceneData& scene, Pass pass, std::vector<ClpvView> views,
               const ClpvLight& light);
  ~GlRasterizer();

  /// Draws all views and waits for the result.
  void draw();

  /// Depth [m] of each view, row by row from the top; 0 where there is no surface. Empty for
  /// rasterize_shadow.
  std::vector<std::vector<float>> depths();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace clpv::bench
