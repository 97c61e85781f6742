// SPDX-License-Identifier: MIT
// Projects points of the scene to the screen, W at a time (lanes.h).
//
// Two triangles that share a corner must project it to the same place, to the bit, in any lane:
// FP_CONTRACT is off.
#pragma once

#pragma OPENCL FP_CONTRACT OFF

#include "lanes.h"
#include "shared/raster.h"
#include "raster/triangle.h"

// Points in the coordinates of a view.
typedef struct {
  realW x, y, z;  // along right, up and forward [m]
  realW w;        // divisor of x and y: the depth z in perspective, 1 in orthographic views
} ViewPoint;

static inline ViewPoint view_point(const ClpvView view, const Vec position) {
  const Vec p = vec_minus(position, vec_of(view.eye));
  ViewPoint point;
  point.x = vec_dot(p, vec_of(view.right));
  point.y = vec_dot(p, vec_of(view.up));
  point.z = vec_dot(p, vec_of(view.forward));
  point.w = is_orthographic(view) ? ONE : point.z;
  return point;
}

// Extent of the guard band on the screen, in units of screen_point().
static inline float2 guard_band(const ClpvView view) {
  return (float2)(view.half_width / (float)view.width, view.half_height / (float)view.height) *
         (2.0f * CLPV_GUARD_PIXELS);
}

// Outcodes of the points: CLPV_LEFT and so on.
static inline intW outcodes_of(const ClpvView view, const ViewPoint p) {
  const float2 guard = guard_band(view);
  const realW width = view.half_width * p.w, height = view.half_height * p.w;
  intW where = (all_bits(p.x < -width) & CLPV_LEFT) | (all_bits(p.x > width) & CLPV_RIGHT) |
               (all_bits(p.y > height) & CLPV_ABOVE) | (all_bits(p.y < -height) & CLPV_BELOW) |
               (all_bits(p.z > view.far_depth) & CLPV_BEYOND);
  if (!is_orthographic(view)) where |= all_bits(p.z < view.near_depth) & CLPV_BEHIND;
  const intW in_guard = (fabs(p.x) <= guard.x * p.w) & (fabs(p.y) <= guard.y * p.w);
  return where | (all_bits(in_guard == 0) & CLPV_OUT_OF_GUARD);
}

// One corner of W triangles on the screen.
typedef struct {
  intW x, y;   // [1/CLPV_SUBPIXELS pixel] from the left and top border
  realW key;  // linear in pixels, smaller is nearer: orthographic depth, perspective -1 / depth
} ScreenCorner;

static inline intW subpixel(const realW screen, const float half_extent, const float pixels) {
  return to_intW_rte((screen / half_extent + 1.0f) * (0.5f * CLPV_SUBPIXELS) * pixels);
}

static inline ScreenCorner project(const ClpvView view, const ViewPoint p) {
  ScreenCorner corner;
  realW x = p.x, y = -p.y, key = p.z;
  if (!is_orthographic(view)) x /= p.w, y /= p.w, key = -1.0f / p.z;
  corner.x = subpixel(x, view.half_width, (float)view.width);
  corner.y = subpixel(y, view.half_height, (float)view.height);
  corner.key = key;
  return corner;
}
