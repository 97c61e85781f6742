// What a view sees, pixel by pixel: depth, normal, colour; and where a pixel's surface is (kernels/shared/view.h).
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

static inline float3 clpv_float3(const float v[3]) { return (float3)(v[0], v[1], v[2]); }

// (sx, sy) of a pixel's centre.
static inline float2 clpv_screen(const ClpvView view, const float px, const float py) {
  return (float2)((2.0f * (px + 0.5f) / (float)view.width - 1.0f) * view.half_width,
                  (1.0f - 2.0f * (py + 0.5f) / (float)view.height) * view.half_height);
}

// The surface point [m] at depth [m] behind pixel (px, py).
static inline float3 clpv_position(const ClpvView view, const float px, const float py, const float depth) {
  const float2 s = clpv_screen(view, px, py) * (view.orthographic != 0.0f ? 1.0f : depth);
  return clpv_float3(view.eye) + depth * clpv_float3(view.forward) + s.x * clpv_float3(view.right) +
         s.y * clpv_float3(view.up);
}

// Unit direction from the eye through the pixel.
static inline float3 clpv_ray(const ClpvView view, const float px, const float py) {
  if (view.orthographic != 0.0f) return clpv_float3(view.forward);
  const float2 s = clpv_screen(view, px, py);
  return normalize(clpv_float3(view.forward) + s.x * clpv_float3(view.right) + s.y * clpv_float3(view.up));
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
  return normalize(convert_float3(normals[pixel].xyz) * (2.0f / 255.0f) - 1.0f);
#else
  return normals[pixel].xyz;
#endif
}

static inline void clpv_store_normal(__global SurfaceTexel* normals, const uint pixel, const float3 normal) {
#if CLPV_SURFACE_PAPER
  normals[pixel] = convert_uchar4_sat_rte((float4)(normal * 127.5f + 127.5f, 255.0f));
#else
  normals[pixel] = (float4)(normal, 0.0f);
#endif
}

// `scale`: what a stored 1 means (the light's largest flux a texel; 1 for albedo).
static inline float3 clpv_load_colour(__global const SurfaceTexel* colours, const uint pixel, const float scale) {
#if CLPV_SURFACE_PAPER
  return convert_float3(colours[pixel].xyz) * (scale / 255.0f);
#else
  return colours[pixel].xyz;
#endif
}

static inline void clpv_store_colour(__global SurfaceTexel* colours, const uint pixel, const float3 colour,
                                     const float scale) {
#if CLPV_SURFACE_PAPER
  colours[pixel] = convert_uchar4_sat_rte((float4)(colour * (255.0f / scale), 255.0f));
#else
  colours[pixel] = (float4)(colour, 1.0f);
#endif
}

#endif
