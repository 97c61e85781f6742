// SPDX-License-Identifier: MIT
// Stage `shade`: computes shadowed direct light and the images that a frame can show
// (kernels/raster/shade.cl).
#pragma once

#include <CL/opencl.hpp>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "options/show.hpp"
#include "pipeline/raster/shadow_maps.hpp"
#include "pipeline/raster/surface.hpp"

namespace clpv {

class Shader {
 public:
  /// `medium`: lights have one.
  explicit Shader(Session& session, bool medium = false);

  /// Computes the irradiance E of all lights on every surface in `camera`; show() displays it as
  /// direct light. Throws Error(run_time) for a camera surface in format paper, a number of maps
  /// other than that of the views, or maps smaller than the filter's 4 x 4 texels.
  void light(const Surface& camera, const std::vector<ShadowedLight>& lights);

  /// `camera`: that of the last light() call. `irradiance`: from the volumes (Gatherer). `image`:
  /// float4 per pixel, linear, finite RGBA; alpha is 1 on surfaces. Pixels without a surface are
  /// all 0.
  void show(Show what, const Surface& camera, const Buffer& irradiance, Buffer& image);

 private:
  Session& session_;
  Kernel light_, shade_;
  Buffer direct_;  // float4 per pixel, E of all lights
  std::size_t pixels_ = 0;
};

}  // namespace clpv
