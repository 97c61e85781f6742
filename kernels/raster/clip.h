// SPDX-License-Identifier: MIT
// Clips a triangle against the near plane and the guard band (Sutherland and Hodgman 1974).
//
// A point is (x, y, w, z): along right and up [m], the divisor of its screen position (perspective:
// the depth; orthographic: 1), and the depth. Two triangles that share an edge must clip it at the
// same point, to the bit. Intersections are therefore computed from the corner inside to the one
// outside, and FP_CONTRACT is off (project.h).
#pragma once

#include "raster/project.h"

enum { CLPV_CLIP_PLANES = 5 };

// A polygon of CLPV_CLIP_CORNERS corners, CLPV_CORNER apart. Corners are indexed at run time: GPUs
// keep such a private array in scratch memory, so with one lane polygons lie in local memory,
// corners of a work-group's CLPV_CLIP_GROUP work-items next to each other.
enum { CLPV_CLIP_GROUP = 64 };
#if W == 1
#define CLPV_POLYGON __local
#define CLPV_CORNER CLPV_CLIP_GROUP
#else
#define CLPV_POLYGON
#define CLPV_CORNER 1
#endif

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
  return is_orthographic(view) ? 1.0f : p.w - view.near_depth;
}

// Clips a convex polygon of `count` corners to the positive side of a plane. Returns the number of
// corners. Works in place: step i reads corner i + 1 before it writes, and at most i + 2 corners
// exist after it. Rounding can produce more on an edge in the plane; they are dropped.
static inline int clip_by_plane(const ClpvView view, CLPV_POLYGON float4* polygon, const int count,
                                const int plane) {
  int kept = 0;
  const float4 first = polygon[0];
  float4 a = first;
  for (int i = 0; i < count; ++i) {
    const float4 b = i + 1 == count ? first : polygon[CLPV_CORNER * (i + 1)];
    const float da = clip_distance(view, a, plane), db = clip_distance(view, b, plane);
    const int room = min(i + 2, CLPV_CLIP_CORNERS);
    if (da >= 0.0f && kept < room) polygon[CLPV_CORNER * kept++] = a;
    if ((da >= 0.0f) != (db >= 0.0f) && kept < room) {
      const float4 inside = da >= 0.0f ? a : b, outside = da >= 0.0f ? b : a;
      const float di = da >= 0.0f ? da : db, dd = da >= 0.0f ? db : da;
      float4 hit = inside + (outside - inside) * (di / (di - dd));
      if (plane == CLPV_CLIP_PLANES - 1)
        hit.zw = is_orthographic(view) ? hit.zw : (float2)(view.near_depth);
      polygon[CLPV_CORNER * kept++] = hit;
    }
    a = b;
  }
  return kept;
}

// Clips the triangle that is the first three corners of `polygon`. Returns the number of corners; 0
// if nothing is left. The near plane comes first, since the guard planes intersect in the eye.
static inline int clip_polygon(const ClpvView view, CLPV_POLYGON float4* polygon) {
  int count = 3;
  for (int plane = CLPV_CLIP_PLANES - 1; plane >= 0; --plane)
    count = clip_by_plane(view, polygon, count, plane);
  return count < 3 ? 0 : count;
}

// Corners of a clipped polygon on the screen, for a fan of triangles about the first.
#if W > 1

// Padded so that W lanes can be loaded from any of them.
typedef struct {
  int x[CLPV_CLIP_CORNERS + W], y[CLPV_CLIP_CORNERS + W];
  float key[CLPV_CLIP_CORNERS + W];
} Outline;

static inline void project_polygon(const ClpvView view, const float4* polygon, const int corners,
                                   Outline* outline) {
  for (int k = 0; k < CLPV_CLIP_CORNERS + W; ++k) {
    const float4 at = polygon[k < corners ? k : 0];
    const ViewPoint point = {(realW)(at.x), (realW)(at.y), (realW)(at.w), (realW)(at.z)};
    const ScreenCorner corner = project(view, point);
    outline->x[k] = first_lane(corner.x);
    outline->y[k] = first_lane(corner.y);
    outline->key[k] = first_lane(corner.key);
  }
}

// Corners k to k + W - 1.
static inline ScreenCorner outline_corners(const ClpvView view, const Outline* outline,
                                           const int k) {
  const ScreenCorner corner = {load_lanes(outline->x + k), load_lanes(outline->y + k),
                               load_lanes(outline->key + k)};
  return corner;
}

// The first corner, W times.
static inline ScreenCorner outline_apex(const ClpvView view, const Outline* outline) {
  const ScreenCorner corner = {(intW)(outline->x[0]), (intW)(outline->y[0]),
                               (realW)(outline->key[0])};
  return corner;
}

#else

typedef struct {
  CLPV_POLYGON const float4* polygon;  // projected corner by corner, as they are needed
} Outline;

static inline void project_polygon(const ClpvView view, CLPV_POLYGON const float4* polygon,
                                   const int corners, Outline* outline) {
  outline->polygon = polygon;
}

CLPV_INLINE ScreenCorner outline_corners(const ClpvView view, const Outline* outline, const int k) {
  const float4 at = outline->polygon[CLPV_CORNER * k];
  const ViewPoint point = {at.x, at.y, at.w, at.z};
  return project(view, point);
}

CLPV_INLINE ScreenCorner outline_apex(const ClpvView view, const Outline* outline) {
  return outline_corners(view, outline, 0);
}

#endif
