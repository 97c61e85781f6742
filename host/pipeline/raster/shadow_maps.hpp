// SPDX-License-Identifier: MIT
// Lights with their shadow maps, and the loop of kernels that take one map at a time
// (kernels/raster/lighting.h, kernels/raster/shadow.h).
#pragma once

#include <algorithm>
#include <vector>

#include "device/kernel.hpp"
#include "device/memory.hpp"
#include "kernels/shared/light.h"
#include "kernels/shared/view.h"

namespace clpv {

/// A light and its shadow maps: a depth buffer per view, one float per texel, row 0 first. Depth is
/// along the view's forward axis [m]; 0 means no surface. Several views share their eye and
/// together cover all lit directions. A surface uses the view whose forward axis is nearest to its
/// direction. Without a view the light casts no shadow. A surface outside the map is lit.
struct ShadowedLight {
  ClpvLight light{};
  std::vector<ClpvView> views = {};
  std::vector<Buffer> depths = {};
  Buffer view_table = {};  ///< `views` on the device
};

/// Returns the light with its intensity multiplied by a factor.
inline ClpvLight scaled(ClpvLight light, float scale) {
  for (float& component : light.intensity) component *= scale;
  return light;
}
inline std::vector<ShadowedLight> scaled(std::vector<ShadowedLight> lights, float scale) {
  for (ShadowedLight& shadowed : lights) shadowed.light = scaled(shadowed.light, scale);
  return lights;
}

/// Adds a light, its views, their number, the index `which` of a map and its depths to the
/// arguments.
inline Kernel& add_shadow_map(Kernel& kernel, const ShadowedLight& shadowed, cl_uint which) {
  const cl_uint count = shadowed.views.size();
  return kernel.add(shadowed.light, shadowed.view_table, count, which,
                    count > 0 ? shadowed.depths[which] : Buffer());
}

/// Calls launch(light, which) for each shadow map of each light in order, and once for a light
/// without one.
template <typename Launch>
void for_each_shadow_map(const std::vector<ShadowedLight>& lights, const Launch& launch) {
  for (const ShadowedLight& shadowed : lights) {
    const cl_uint count = std::max<cl_uint>(shadowed.views.size(), 1);
    for (cl_uint which = 0; which < count; ++which) launch(shadowed, which);
  }
}

}  // namespace clpv
