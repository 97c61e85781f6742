// SPDX-License-Identifier: MIT
// Stage `shade`: light straight from the lights, shadowed, and the images a frame can show
// (kernels/shade.cl).
#pragma once

#include <CL/opencl.hpp>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "kernels/shared/light.h"
#include "options/show.hpp"
#include "pipeline/surface.hpp"

namespace clpv {

/// A light and the maps its shadows come from: a depth buffer a view (float a texel, row 0 first, [m] along
/// the view's forward axis, 0: nothing there). Several views share their eye and together see all that is
/// lit; a surface takes the one that looks most along it. No view: the light casts no shadow. A surface
/// outside the map is lit.
struct ShadowedLight {
  ClpvLight light{};
  std::vector<ClpvView> views;
  std::vector<Buffer> depths;
};

class Shader {
 public:
  explicit Shader(Session& session);

  /// E of all lights on every surface the camera sees; what show() then shows as direct light.
  /// Throws Error(run_time) for a camera's view in format paper, maps that are not one a view, or smaller
  /// than the filter's 4 x 4 texels.
  void light(const Surface& camera, const std::vector<ShadowedLight>& lights);

  /// `camera` as given to light() last. `irradiance`: of the volumes (Gatherer). `image`: float4 a pixel,
  /// RGBA, linear, finite; alpha 1 where there is a surface, else all 0.
  void show(Show what, const Surface& camera, const Buffer& irradiance, Buffer& image);

 private:
  void add(const Surface& camera, const ShadowedLight& shadowed, bool fresh);

  Session& session_;
  Kernel light_, shade_;
  Buffer direct_;  // float4 a pixel, E of all lights
  Buffer views_;   // of the light at hand
  std::size_t pixels_ = 0;
};

}  // namespace clpv
