// SPDX-License-Identifier: MIT
// Shades the surfaces that the camera sees: direct light with shadow maps, and the image.
//
//   L = albedo / pi (E_direct + E_indirect) + L_emitted      (docs/method.md, 'Shading')
//
// light_surfaces
//   In:      depths [m], normals   the camera's surface (surface.h)
//            light, views, count   the light and its views; count 0: no shadows
//            which, map            the view whose receivers to light, and its shadow map: depths
//                                  [m]
//            clear                 1: overwrite `direct`; 0: add to it
//   In, out: direct                E_direct [W/m^2] per pixel
//   A work-item lights W pixels of a row.
// shade
//   In:      show                  CLPV_SHOW_* (shared/shade.h)
//            depths, normals, albedos, emissive (may be null), direct, indirect   per pixel
//   Out:     image                 RGBA, all 0 for empty pixels
#include "raster/shadow.h"
#include "raster/surface.h"
#include "raster/surface_row.h"

__kernel void light_surfaces(const ClpvView camera, __global const float* depths,
                             __global const float4* normals, const ClpvLight light,
                             __global const ClpvView* views, const uint count, const uint which,
                             __global const float* map, const uint clear, __global float4* direct) {
  const PixelRow p = find_pixel_row(camera);
  if (p.count == 0) return;
  Surfaces seen;
  load_surfaces(camera, p, depths, normals, &seen);
  intW lit = seen.depth > ZERO;
  const ShadowMap shadow = {views, count, which, map};
  const Vec irradiance =
      shadowed_irradiance(light, shadow, seen.position, seen.normal, seen.geometric, &lit);
  const VecLanes lanes = unpack(lit, irradiance);
  for (uint i = 0; i < p.count; ++i) {
    const float4 added = (float4)(lanes.x[i], lanes.y[i], lanes.z[i], 0.0f);
    direct[seen.first + i] = clear ? added : direct[seen.first + i] + added;
  }
}

__kernel void shade(const uint show, const uint pixels, __global const float* depths,
                    __global const SurfaceTexel* normals, __global const SurfaceTexel* albedos,
                    __global const float4* emissive, __global const float4* direct,
                    __global const float4* indirect, __global float4* image) {
  const uint pixel = get_global_id(0);
  if (pixel >= pixels) return;
  const float depth = depths[pixel];
  if (depth <= 0.0f) {
    image[pixel] = (float4)(0.0f);
    return;
  }
  const float3 albedo = load_colour(albedos, pixel, 1.0f);
  float3 shown = 0.0f;
  if (show == CLPV_SHOW_FULL || show == CLPV_SHOW_DIRECT) {
    shown += albedo * M_1_PI_F * direct[pixel].xyz;
    if (emissive) shown += emissive[pixel].xyz;
  }
  if (show == CLPV_SHOW_FULL || show == CLPV_SHOW_INDIRECT)
    shown += albedo * M_1_PI_F * indirect[pixel].xyz;
  if (show == CLPV_SHOW_IRRADIANCE) shown = indirect[pixel].xyz;
  if (show == CLPV_SHOW_ALBEDO) shown = albedo;
  if (show == CLPV_SHOW_NORMAL) shown = load_normal(normals, pixel);
  if (show == CLPV_SHOW_DEPTH) shown = depth;
  image[pixel] = (float4)(shown.x, shown.y, shown.z, 1.0f);
}
