// SPDX-License-Identifier: MIT
// What a view sees, pixel by pixel: depth, normal, colour; and where a pixel's surface is (kernels/shared/view.h).
// Scalars throughout, float3 only to hand them over: work-items vectorise (lanes.h).
// CLPV_SURFACE_PAPER 1: normals and colours as 8-bit normalised integers, the paper's RSM format; 0: as float4.
#ifndef CLPV_SURFACE_H
#define CLPV_SURFACE_H

#include "shared/view.h"

#ifndef CLPV_SURFACE_PAPER
#define CLPV_SURFACE_PAPER 0
#endif

#if CLPV_SURFACE_PAPER
typedef uchar4 SurfaceTexel;
#else
typedef float4 SurfaceTexel;
#endif

// Whether a view's rays are parallel. Where a kernel is built for the views of one kind, the host says so by the literal
// CLPV_ORTHOGRAPHIC (1: they are); otherwise the view does.
#ifdef CLPV_ORTHOGRAPHIC
#define CLPV_PARALLEL(view) CLPV_ORTHOGRAPHIC
#else
#define CLPV_PARALLEL(view) ((view).orthographic != 0.0f)
#endif

// (sx, sy) of a pixel's centre.
static inline float2 clpv_screen(const ClpvView view, const float px, const float py) {
  return (float2)((2.0f * (px + 0.5f) / (float)view.width - 1.0f) * view.half_width,
                  (1.0f - 2.0f * (py + 0.5f) / (float)view.height) * view.half_height);
}

// The surface point [m] at depth [m] behind pixel (px, py).
static inline float3 clpv_position(const ClpvView view, const float px, const float py, const float depth) {
  const float2 s = clpv_screen(view, px, py);
  const float scale = view.orthographic != 0.0f ? 1.0f : depth;
  const float sx = scale * s.x, sy = scale * s.y;
#define CLPV_AT(a) (view.eye[a] + depth * view.forward[a] + sx * view.right[a] + sy * view.up[a])
  return (float3)(CLPV_AT(0), CLPV_AT(1), CLPV_AT(2));
#undef CLPV_AT
}

// Unit direction from the eye through the pixel.
static inline float3 clpv_ray(const ClpvView view, const float px, const float py) {
  const float2 s = clpv_screen(view, px, py);
  const float sx = view.orthographic != 0.0f ? 0.0f : s.x, sy = view.orthographic != 0.0f ? 0.0f : s.y;
  const float scale = rsqrt(1.0f + sx * sx + sy * sy);
#define CLPV_ALONG(a) (scale * (view.forward[a] + sx * view.right[a] + sy * view.up[a]))
  return (float3)(CLPV_ALONG(0), CLPV_ALONG(1), CLPV_ALONG(2));
#undef CLPV_ALONG
}

// Area [m^2] of the pixel's footprint across its ray: perspective, distance^2 times the pixel's solid angle.
static inline float clpv_footprint(const ClpvView view, const float px, const float py, const float depth) {
  const float pixel = 4.0f * view.half_width * view.half_height / ((float)view.width * (float)view.height);
  if (view.orthographic != 0.0f) return pixel;
  const float2 s = clpv_screen(view, px, py);
  return depth * depth * pixel * rsqrt(1.0f + s.x * s.x + s.y * s.y);
}

static inline float3 clpv_load_normal(__global const SurfaceTexel* normals, const uint pixel) {
#if CLPV_SURFACE_PAPER
  __global const uchar* n = (__global const uchar*)(normals + pixel);
  const float x = n[0] * (2.0f / 255.0f) - 1.0f, y = n[1] * (2.0f / 255.0f) - 1.0f,
              z = n[2] * (2.0f / 255.0f) - 1.0f;
  const float scale = rsqrt(x * x + y * y + z * z);
  return (float3)(scale * x, scale * y, scale * z);
#else
  __global const float* n = (__global const float*)(normals + pixel);
  return (float3)(n[0], n[1], n[2]);
#endif
}

// `scale`: what a stored 1 means (the light's largest flux a texel; 1 for albedo).
static inline float3 clpv_load_colour(__global const SurfaceTexel* colours, const uint pixel,
                                      const float scale) {
#if CLPV_SURFACE_PAPER
  __global const uchar* c = (__global const uchar*)(colours + pixel);
  return (float3)(c[0] * (scale / 255.0f), c[1] * (scale / 255.0f), c[2] * (scale / 255.0f));
#else
  __global const float* c = (__global const float*)(colours + pixel);
  return (float3)(c[0], c[1], c[2]);
#endif
}

#endif
