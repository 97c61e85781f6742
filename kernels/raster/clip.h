// SPDX-License-Identifier: MIT
// Clips a triangle against the near plane and the guard band (Sutherland and Hodgman 1974).
//
// A point is (x, y, w, z): along right and up [m], the divisor of its screen position (perspective: the depth;
// orthographic: 1), and the depth. Two triangles that share an edge must clip it at the same point, to the bit.
// Intersections are therefore computed from the corner inside to the one outside, and FP_CONTRACT is off (project.h).
#ifndef CLPV_CLIP_H
#define CLPV_CLIP_H

#include "raster/project.h"

#define CLPV_CLIP_PLANES 5

// Point of the first lane.
static inline float4 polygon_corner(const ViewPoint p) {
  return (float4)(first_lane(p.x), first_lane(p.y), first_lane(p.w), first_lane(p.z));
}

// Signed distance of a point from a clipping plane; negative outside.
static inline float clip_distance(const ClpvView view, const float4 p, const int plane) {
  const float2 guard = guard_band(view);
  if (plane == 0) return guard.x * p.z - p.x;
  if (plane == 1) return guard.x * p.z + p.x;
  if (plane == 2) return guard.y * p.z - p.y;
  if (plane == 3) return guard.y * p.z + p.y;
  return CLPV_PARALLEL(view) ? 1.0f : p.w - view.near_depth;
}

// Clips the convex polygon `from` to the positive side of a plane. Returns the number of corners.
static inline int clip_by_plane(const ClpvView view, const float4* from, const int count, const int plane,
                                float4* to) {
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const float4 a = from[i], b = from[i + 1 == count ? 0 : i + 1];
    const float da = clip_distance(view, a, plane), db = clip_distance(view, b, plane);
    if (da >= 0.0f && kept < CLPV_CLIP_CORNERS) to[kept++] = a;
    if ((da >= 0.0f) != (db >= 0.0f) && kept < CLPV_CLIP_CORNERS) {
      const float4 inside = da >= 0.0f ? a : b, outside = da >= 0.0f ? b : a;
      const float di = da >= 0.0f ? da : db, dd = da >= 0.0f ? db : da;
      float4 hit = inside + (outside - inside) * (di / (di - dd));
      if (plane == CLPV_CLIP_PLANES - 1) hit.zw = CLPV_PARALLEL(view) ? hit.zw : (float2)(view.near_depth);
      to[kept++] = hit;
    }
  }
  return kept;
}

// Clips the triangle in polygon[0..2]. Returns the number of corners in `polygon`; 0 if nothing is left. The near plane
// comes first, since the guard planes intersect in the eye.
static inline int clip_polygon(const ClpvView view, float4* polygon) {
  float4 other[CLPV_CLIP_CORNERS];
  int count = 3;
  for (int plane = CLPV_CLIP_PLANES - 1; plane >= 0; --plane) {
    count = clip_by_plane(view, polygon, count, plane, other);
    for (int i = 0; i < count; ++i) polygon[i] = other[i];
  }
  return count < 3 ? 0 : count;
}

#endif
