// SPDX-License-Identifier: MIT
// Surfaces of W pixels of a row at a time: position, footprint, load and store (surface.h has the
// formulas).
#pragma once

#include "lanes.h"
#include "raster/geometric_normal.h"
#include "raster/surface.h"
#include "raster/tile_row.h"
#include "vec.h"

// Screen coordinates (sx, sy) of the pixels' centres.
typedef struct {
  realW x, y;
} ScreenPoints;

static inline ScreenPoints find_screen_points(const ClpvView view, const PixelRow p) {
  const ScreenPoints s = {(2.0f * (p.x + 0.5f) / (float)view.width - 1.0f) * view.half_width,
                      (1.0f - 2.0f * (p.y + 0.5f) / (float)view.height) * view.half_height};
  return s;
}

// Points [m] at `depth` [m] behind the pixels.
static inline Vec row_positions(const ClpvView view, const PixelRow p, const realW depth) {
  const ScreenPoints s = find_screen_points(view, p);
  const realW scale = view.orthographic != 0.0f ? ONE : depth;
  const realW sx = scale * s.x, sy = scale * s.y;
  realW at[3];
#pragma unroll
  for (int a = 0; a < 3; ++a)
    at[a] = view.eye[a] + depth * view.forward[a] + sx * view.right[a] + sy * view.up[a];
  return vec(at[0], at[1], at[2]);
}

// Footprints [m^2] of the pixels across their rays.
static inline realW row_footprints(const ClpvView view, const PixelRow p, const realW depth) {
  const float pixel =
      4.0f * view.half_width * view.half_height / ((float)view.width * (float)view.height);
  if (view.orthographic != 0.0f) return (realW)(pixel);
  const ScreenPoints s = find_screen_points(view, p);
  return depth * depth * pixel * rsqrt(1.0f + s.x * s.x + s.y * s.y);
}

// Surfaces of W pixels.
typedef struct {
  uint first;  // index of the first pixel in the view
  realW depth;
  Vec position, normal;
  Vec geometric;  // normal of the triangle (shared/normal.h)
} Surfaces;

// Loads the surfaces of W pixels. Lanes outside the view repeat the last pixel.
static inline void load_surfaces(const ClpvView view, const PixelRow p,
                                 __global const float* depths, __global const float4* normals,
                                 Surfaces* s) {
  s->first = p.py * view.width + p.px;
  const uintW pixel = s->first + min(as_uintW(lane_numbers()), (uintW)(p.count - 1));
  Rows rows;
  gather_rows(normals, pixel, &rows);
  s->depth = (realW)CLPV_GATHER(depths, pixel);
  s->normal = vec(CLPV_COLUMN(rows, x), CLPV_COLUMN(rows, y), CLPV_COLUMN(rows, z));
  s->geometric = unpack_geometric_normal(CLPV_COLUMN(rows, w), s->normal);
  s->position = row_positions(view, p, s->depth);
}

// Loads W points without a view: positions [m], w the depth, 1, or 0 without a surface.
static inline void load_points(const ClpvView view, const PixelRow p, __global const float4* at,
                               __global const float4* normals, Surfaces* s) {
  s->first = p.py * view.width + p.px;
  const uintW pixel = s->first + min(as_uintW(lane_numbers()), (uintW)(p.count - 1));
  Rows rows;
  gather_rows(at, pixel, &rows);
  s->position = vec(CLPV_COLUMN(rows, x), CLPV_COLUMN(rows, y), CLPV_COLUMN(rows, z));
  s->depth = CLPV_COLUMN(rows, w);
  gather_rows(normals, pixel, &rows);
  s->normal = vec(CLPV_COLUMN(rows, x), CLPV_COLUMN(rows, y), CLPV_COLUMN(rows, z));
  s->geometric = unpack_geometric_normal(CLPV_COLUMN(rows, w), s->normal);
}

// Ways [m] from positions to the eye, or to its plane; 0 for points without a view.
static inline Vec towards_eye(const ClpvView view, const Vec position) {
  const Vec way = vec_minus(vec_of(view.eye), position), forward = vec_of(view.forward);
  if (view.orthographic != 0.0f) return vec_times(forward, vec_dot(way, forward));
  return vec_times(way, view.half_width > 0.0f ? ONE : ZERO);
}

// Place of a surface: its depth in the view, or with CLPV_POINTS 1 a point without a view.
#if CLPV_POINTS
typedef float4 Place;
#define CLPV_LOAD_SURFACES load_points
#else
typedef float Place;
#define CLPV_LOAD_SURFACES load_surfaces
#endif

// Numbers of stored texels. `scale`: as in load_colour().
#if CLPV_SURFACE_PAPER
typedef uchar Channel;
typedef bytesW channelW;
// Same as a saturating conversion of value + 0.5f, which PoCL does not inline (lanes.h).
static inline bytesW to_bytes(const realW value) {
  const realW all = (realW)(255.0f);
  return to_bytesW(to_intW((value > ZERO ? (value < all ? value : all) : ZERO) + 0.5f));
}
static inline bytesW stored_normal(const realW n) { return to_bytes(n * 127.5f + 127.5f); }
static inline bytesW stored_geometric(const realW geometric) { return (bytesW)(255); }
static inline bytesW stored_colour(const realW c, const float scale) {
  return to_bytes(c * (255.0f / scale));
}
static inline bytesW stored_alpha(void) { return (bytesW)(255); }
#else
typedef float Channel;
typedef realW channelW;
static inline realW stored_normal(const realW n) { return n; }
static inline realW stored_geometric(const realW geometric) { return geometric; }
static inline realW stored_colour(const realW c, const float scale) { return c; }
static inline realW stored_alpha(void) { return ONE; }
#endif

#if W == 8

// Interleaved numbers, and interleaved pairs of numbers; compilers turn these into shuffles.
// Element by element: Oclgrind crashes on vectors built from vectors.
static inline channelW interleave(const SurfaceTexel a, const SurfaceTexel b) {
  return (channelW)(a.x, b.x, a.y, b.y, a.z, b.z, a.w, b.w);
}
static inline channelW interleave_pairs(const SurfaceTexel a, const SurfaceTexel b) {
  return (channelW)(a.x, a.y, b.x, b.y, a.z, a.w, b.z, b.w);
}

// Stores `count` texels of four numbers from `to` on.
CLPV_INLINE void store_texels(const uint count, const channelW x, const channelW y,
                              const channelW z, const channelW w, __global SurfaceTexel* to) {
  const channelW left_xy = interleave(x.lo, y.lo), left_zw = interleave(z.lo, w.lo);
  const channelW right_xy = interleave(x.hi, y.hi), right_zw = interleave(z.hi, w.hi);
  const channelW twos[4] = {
      interleave_pairs(left_xy.lo, left_zw.lo), interleave_pairs(left_xy.hi, left_zw.hi),
      interleave_pairs(right_xy.lo, right_zw.lo), interleave_pairs(right_xy.hi, right_zw.hi)};
  __global Channel* numbers = (__global Channel*)to;
  if (count == W) {
    for (int i = 0; i < 4; ++i) vstore8(twos[i], i, numbers);
    return;
  }
  for (uint i = 0; i < count; ++i)
    vstore4(i % 2 == 0 ? twos[i / 2].lo : twos[i / 2].hi, i, numbers);
}

#else

CLPV_INLINE void store_texels(const uint count, const channelW x, const channelW y,
                              const channelW z, const channelW w, __global SurfaceTexel* to) {
  if (count == W) *to = (SurfaceTexel)(x, y, z, w);
}

#endif

// `geometric`: numbers of the geometric normals, for which the 8-bit format has no room.
CLPV_INLINE void store_normals(const PixelRow p, const Vec n, const realW geometric,
                               __global SurfaceTexel* to) {
  store_texels(p.count, stored_normal(n.x), stored_normal(n.y), stored_normal(n.z),
               stored_geometric(geometric), to);
}

CLPV_INLINE void store_colours(const PixelRow p, const Vec c, const float scale,
                               __global SurfaceTexel* to) {
  store_texels(p.count, stored_colour(c.x, scale), stored_colour(c.y, scale),
               stored_colour(c.z, scale), stored_alpha(), to);
}
