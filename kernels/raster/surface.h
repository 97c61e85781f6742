// SPDX-License-Identifier: MIT
// Surfaces of a view, pixel by pixel: position, ray and footprint (shared/view.h), and stored
// normal and colour.
//
//   position = eye + d forward + s_x right + s_y up      (times d in perspective)
//
// CLPV_SURFACE_PAPER 1: normals and colours are 8-bit normalised integers, the paper's RSM format;
// 0: float4. Arithmetic is scalar so that work-items vectorise (lanes.h); float3 only returns
// results.
#pragma once

#include "shared/view.h"

// `scale` of a colour: value of a stored 1 (largest flux of a texel of the light [W]; 1 for
// albedo). Only the 8-bit format uses it.
#if CLPV_SURFACE_PAPER
typedef uchar4 SurfaceTexel;

static inline float3 load_normal(__global const SurfaceTexel* normals, const uint pixel) {
  __global const uchar* n = (__global const uchar*)(normals + pixel);
  const float x = n[0] * (2.0f / 255.0f) - 1.0f, y = n[1] * (2.0f / 255.0f) - 1.0f,
              z = n[2] * (2.0f / 255.0f) - 1.0f;
  const float scale = rsqrt(x * x + y * y + z * z);
  return (float3)(scale * x, scale * y, scale * z);
}

static inline float3 load_colour(__global const SurfaceTexel* colours, const uint pixel,
                                 const float scale) {
  __global const uchar* c = (__global const uchar*)(colours + pixel);
  return (float3)(c[0] * (scale / 255.0f), c[1] * (scale / 255.0f), c[2] * (scale / 255.0f));
}
#else
typedef float4 SurfaceTexel;

static inline float3 load_normal(__global const SurfaceTexel* normals, const uint pixel) {
  __global const float* n = (__global const float*)(normals + pixel);
  return (float3)(n[0], n[1], n[2]);
}

static inline float3 load_colour(__global const SurfaceTexel* colours, const uint pixel,
                                 const float scale) {
  __global const float* c = (__global const float*)(colours + pixel);
  return (float3)(c[0], c[1], c[2]);
}
#endif

// The literal CLPV_ORTHOGRAPHIC (0 or 1) from the host specialises a kernel for one kind of view.
static inline bool is_orthographic(const ClpvView view) {
#ifdef CLPV_ORTHOGRAPHIC
  return CLPV_ORTHOGRAPHIC;
#else
  return view.orthographic != 0.0f;
#endif
}

// Screen coordinates (sx, sy) of a pixel's centre.
static inline float2 screen_point(const ClpvView view, const float px, const float py) {
  return (float2)((2.0f * (px + 0.5f) / (float)view.width - 1.0f) * view.half_width,
                  (1.0f - 2.0f * (py + 0.5f) / (float)view.height) * view.half_height);
}

// Point [m] at `depth` [m] behind pixel (px, py).
static inline float3 surface_position(const ClpvView view, const float px, const float py,
                                      const float depth) {
  const float2 s = screen_point(view, px, py);
  const float scale = view.orthographic != 0.0f ? 1.0f : depth;
  const float sx = scale * s.x, sy = scale * s.y;
  float at[3];
#pragma unroll
  for (int a = 0; a < 3; ++a)
    at[a] = view.eye[a] + depth * view.forward[a] + sx * view.right[a] + sy * view.up[a];
  return (float3)(at[0], at[1], at[2]);
}

// Unit direction of a pixel's ray, away from the eye.
static inline float3 pixel_ray(const ClpvView view, const float px, const float py) {
  const float2 s = screen_point(view, px, py);
  const float sx = view.orthographic != 0.0f ? 0.0f : s.x,
              sy = view.orthographic != 0.0f ? 0.0f : s.y;
  const float scale = rsqrt(1.0f + sx * sx + sy * sy);
  float along[3];
#pragma unroll
  for (int a = 0; a < 3; ++a)
    along[a] = scale * (view.forward[a] + sx * view.right[a] + sy * view.up[a]);
  return (float3)(along[0], along[1], along[2]);
}

// Footprint [m^2] of a pixel across its ray: distance^2 times the pixel's solid angle in
// perspective.
static inline float pixel_footprint(const ClpvView view, const float px, const float py,
                                    const float depth) {
  const float pixel =
      4.0f * view.half_width * view.half_height / ((float)view.width * (float)view.height);
  if (view.orthographic != 0.0f) return pixel;
  const float2 s = screen_point(view, px, py);
  return depth * depth * pixel * rsqrt(1.0f + s.x * s.x + s.y * s.y);
}
