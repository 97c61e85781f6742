// SPDX-License-Identifier: MIT
// The rasterising passes by OpenGL, without a window (EGL, OpenGL ES 3.2; Mesa's llvmpipe on a machine without a GPU): what the
// OpenCL rasteriser is held against. Like for like: the same views, triangles, materials and formats.
#pragma once

#include <memory>
#include <vector>

#include "kernels/shared/light.h"
#include "kernels/shared/view.h"
#include "options/stages.hpp"
#include "scene/scene.hpp"

namespace clpv::bench {

/// Why there is no such peer here; empty: there is. CLPV_BENCH_GL says whether it was built.
std::string gl_missing();

class GlRasterizer {
 public:
  /// `pass`: rasterize_camera (depth, normal and albedo as floats, a quadruple each of the last two), rasterize_shadow
  /// (depth alone), rasterize_rsm (depth, normal, flux). Of `views`, all of one size. Throws Error(device) where
  /// gl_missing(), Error(run_time) where the driver rejects.
  GlRasterizer(const Scene& scene, Pass pass, std::vector<ClpvView> views, const ClpvLight& light);
  ~GlRasterizer();

  /// All views; returns when they are drawn.
  void draw();

  /// Of each view, as rows from the top: depth [m], 0 where nothing is seen.
  std::vector<std::vector<float>> depths();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace clpv::bench
