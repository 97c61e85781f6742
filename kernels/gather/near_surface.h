// SPDX-License-Identifier: MIT
// Surfaces of the near field's pixels, and which of them are one (near_filter.cl).
#pragma once

#include "gather/near_layout.h"

__constant const float same_normal = 0.7f;  // minimum cosine between normals
__constant const float same_plane = 0.1f;  // maximum distance from the tangent plane [R]

// Surfaces of W pixels.
typedef struct {
  Vec position, normal;
  realW reach;
} NearSurfaces;

CLPV_INLINE void load_near_surfaces(__global const float* points, const uint plane, const uint at,
                                    NearSurfaces* s) {
  s->position = load_plane_vectors(points + CLPV_NEAR_POSITION * plane, plane, at);
  s->normal = load_plane_vectors(points + CLPV_NEAR_NORMAL * plane, plane, at);
  s->reach = load_lanes(points + CLPV_NEAR_REACH * plane + at);
}

// Mask of the lanes whose surface is the one at `position`: similar normal, near its tangent plane.
CLPV_INLINE intW same_surface(const NearSurfaces s, const Vec position, const Vec normal) {
  const realW off = fabs(vec_dot(vec_minus(s.position, position), normal));
  return (vec_dot(normal, s.normal) > (realW)(same_normal)) & (off < same_plane * s.reach);
}

#if CLPV_PLANE_LAYERS > 1
// Spreads pixels over W pixels of the camera from a multiple of W on: each gets the near pixel of
// its block, or with `right` of the next block. Load W of them from spread_from() on.
static inline uint spread_from(const uint first, const bool right) {
  return W == 1 && right ? first + 1u : first;
}
CLPV_INLINE realW spread(const realW v, const bool right) {
#if W == 1
  return v;
#elif CLPV_PLANE_STEP == 2
  return right ? v.s11223344 : v.s00112233;
#elif CLPV_PLANE_STEP == 4
  return right ? v.s11112222 : v.s00001111;
#else
  return right ? v.s11111111 : v.s00000000;
#endif
}
CLPV_INLINE Vec spread_vectors(const Vec v, const bool right) {
  return vec(spread(v.x, right), spread(v.y, right), spread(v.z, right));
}
CLPV_INLINE void spread_surfaces(NearSurfaces* s, const bool right) {
  s->position = spread_vectors(s->position, right);
  s->normal = spread_vectors(s->normal, right);
  s->reach = spread(s->reach, right);
}
#endif
