// SPDX-License-Identifier: MIT
// Clips a triangle against the near plane and the guard band.
//
// A point is (x, y, w, z): along right and up [m], what its screen position is divided by (perspective: the
// depth; orthographic: 1), and the depth. Two triangles that share an edge must clip it at the same point,
// bit by bit: so the plane is met on the way from the corner inside to the one outside, whichever triangle
// asks, and nothing is fused.
#ifndef CLPV_CLIP_H
#define CLPV_CLIP_H

#include "project.h"

#define CLPV_CLIP_PLANES 5
#define CLPV_CLIP_CORNERS 12  // each plane adds one to the three; rounding may, at worst, add a few

// The point in the first lane.
static inline float4 clpv_polygon_corner(const ViewPoint p) { return (float4)(p.x.s0, p.y.s0, p.w.s0, p.z.s0); }

// Signed distance of a point from clipping plane `plane`, negative: cut away.
static inline float clpv_clip_distance(const ClpvView view, const float4 p, const int plane) {
  const float2 guard = clpv_guard(view);
  if (plane == 0) return guard.x * p.z - p.x;
  if (plane == 1) return guard.x * p.z + p.x;
  if (plane == 2) return guard.y * p.z - p.y;
  if (plane == 3) return guard.y * p.z + p.y;
  return CLPV_PARALLEL(view) ? 1.0f : p.w - view.near_depth;
}

// Keeps of the convex polygon `from` what is on the positive side of a plane; returns its number of corners.
static inline int clpv_clip_plane(const ClpvView view, const float4* from, const int count, const int plane,
                                  float4* to) {
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const float4 a = from[i], b = from[i + 1 == count ? 0 : i + 1];
    const float da = clpv_clip_distance(view, a, plane), db = clpv_clip_distance(view, b, plane);
    if (da >= 0.0f && kept < CLPV_CLIP_CORNERS) to[kept++] = a;
    if ((da >= 0.0f) != (db >= 0.0f) && kept < CLPV_CLIP_CORNERS) {
      const float4 inside = da >= 0.0f ? a : b, outside = da >= 0.0f ? b : a;
      const float di = da >= 0.0f ? da : db, dd = da >= 0.0f ? db : da;
      float4 met = inside + (outside - inside) * (di / (di - dd));
      if (plane == CLPV_CLIP_PLANES - 1) met.zw = CLPV_PARALLEL(view) ? met.zw : (float2)(view.near_depth);
      to[kept++] = met;
    }
  }
  return kept;
}

// Clips the triangle in polygon[0..2]; returns how many corners it has left in polygon, 0: nothing.
// The near plane comes first: the guard planes meet in the eye, where nothing may be left.
static inline int clpv_clip(const ClpvView view, float4* polygon) {
  float4 other[CLPV_CLIP_CORNERS];
  int count = 3;
  for (int plane = CLPV_CLIP_PLANES - 1; plane >= 0; --plane) {
    count = clpv_clip_plane(view, polygon, count, plane, other);
    for (int i = 0; i < count; ++i) polygon[i] = other[i];
  }
  return count < 3 ? 0 : count;
}

#endif
