// SPDX-License-Identifier: MIT
// Traces the rays of the near field against the scene's triangles.
//
// In:   points, directions   near_layout.h
//       nodes, leaves        tree of the triangles (triangle_tree.h); CLPV_SCENE: the scene, for masked materials
// Out:  distances            per ray: distance of the hit [m], INFINITY without one; a plane for each k
//       places               weights u and v of the hit's triangle, and the triangle (uint); three planes for each k
// A work-item traces the rays of eight pixels of a row.
#include "near_layout.h"
#include "tile_row.h"
#include "triangle_tree.h"

static inline Vec vec_least(const Vec a, const Vec b) {
  return vec(a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z);
}
static inline Vec vec_most(const Vec a, const Vec b) {
  return vec(a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z);
}

// Box about the boxes of the lanes in the mask `lit`.
static inline Box box_of(const int8 lit, const Vec lower, const Vec upper) {
  const float8 far = (float8)(CLPV_TREE_FAR);
  const Box box = {{clpv_least(lit ? lower.x : far), clpv_least(lit ? lower.y : far), clpv_least(lit ? lower.z : far)},
                   {-clpv_least(lit ? -upper.x : far), -clpv_least(lit ? -upper.y : far),
                    -clpv_least(lit ? -upper.z : far)}};
  return box;
}

__kernel void near_trace(const ClpvView view, __global const float* points, __global const float8* directions,
                         __global const float8* nodes, __global const float8* leaves, CLPV_SCENE,
                         __global float* distances, __global float* places) {
  const NearRow r = near_row(view, get_global_id(0), get_global_id(1));
  if (!near_inside(r)) return;
  NearPoints p;
  near_points_at(points, r, &p);
  const Tree tree = {nodes, leaves};
  const int8 lit = p.reach > (float8)(0.0f);
  const Vec start = vec_add_scaled(p.position, CLPV_NEAR_LIFT * p.reach, p.normal);
  const VecLanes from = unpack(lit, start);
  Vec lower = start, upper = start;
  for (uint k = 0; k < CLPV_NEAR_RAYS; ++k) {
    const Vec end = vec_add_scaled(start, p.reach, near_directions(directions, r, &p, k));
    lower = vec_least(lower, end);
    upper = vec_most(upper, end);
  }
  Entry entry;
  clpv_enter(tree, box_of(lit, lower, upper), &entry);
  float reach[CLPV_ABREAST];
  vstore8(p.reach, 0, reach);
  for (uint k = 0; k < CLPV_NEAR_RAYS; ++k) {
    const VecLanes along = unpack(lit, near_directions(directions, r, &p, k));
    __global float* to = places + 3 * k * r.plane + r.at;
    for (int i = 0; i < CLPV_ABREAST; ++i) {
      Hit hit = {reach[i], 0.0f, 0.0f, 0u};
      bool met = false;
      if (reach[i] > 0.0f) {
        Ray ray;
        clpv_make_ray(from.x[i], from.y[i], from.z[i], along.x[i], along.y[i], along.z[i], &ray);
        met = clpv_nearest_triangle(tree, &entry, &ray, CLPV_PASS_SCENE, &hit);
      }
      distances[k * r.plane + r.at + i] = met ? hit.distance : INFINITY;
      to[i] = hit.u;
      to[r.plane + i] = hit.v;
      to[2 * r.plane + i] = as_float(hit.triangle);
    }
  }
}
