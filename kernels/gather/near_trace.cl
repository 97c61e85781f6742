// SPDX-License-Identifier: MIT
// Traces the rays of the near field against the scene's triangles.
//
// In:   points, directions   near_layout.h
//       nodes, leaves        tree of the triangles (triangle_tree.h); CLPV_SCENE: the scene, for masked materials
// Out:  distances            per ray: distance of the hit [m], INFINITY without one; a plane for each k
//       counts, hits         per tile: number of hits, and their list (near_layout.h)
// A work-item traces the rays of a tile, which share an entry to the tree.
#include "gather/near_layout.h"
#include "triangle_tree.h"

// Widens the bounds along an axis by half balls of radius `reach` about eight points.
CLPV_INLINE void add_half_balls(const int8 lit, const float8 at, const float8 normal, const float8 reach, const int axis,
                                Box* box) {
  const float8 none = (float8)(0.0f), square = 1.0f - normal * normal, sine = sqrt(square > none ? square : none);
  const float8 before = normal > none ? sine : (float8)(1.0f), after = normal < none ? sine : (float8)(1.0f);
  const float8 far = (float8)(CLPV_TREE_FAR);
  const float lower = clpv_least(lit ? at - before * reach : far), upper = -clpv_least(lit ? -(at + after * reach) : far);
  box->lower[axis] = lower < box->lower[axis] ? lower : box->lower[axis];
  box->upper[axis] = upper > box->upper[axis] ? upper : box->upper[axis];
}

// Box about the rays of a tile.
CLPV_INLINE void box_of_tile(const ClpvView view, __global const float* points, Box* box) {
  for (int axis = 0; axis < 3; ++axis) box->lower[axis] = CLPV_TREE_FAR, box->upper[axis] = -CLPV_TREE_FAR;
  for (int y = 0; y < CLPV_NEAR_TILE; ++y) {
    const NearRow r = near_row(view, get_global_id(0), get_global_id(1) * CLPV_NEAR_TILE + y);
    if (!near_inside(r)) continue;
    const Vec p = near_vectors(points + CLPV_NEAR_POSITION * r.plane, r.plane, r.at);
    const Vec n = near_vectors(points + CLPV_NEAR_NORMAL * r.plane, r.plane, r.at);
    const float8 reach = vload8(0, points + CLPV_NEAR_REACH * r.plane + r.at);
    const int8 lit = reach > (float8)(0.0f);
    const float8 wide = reach * (1.0f + 2.0f * CLPV_NEAR_LIFT);
    add_half_balls(lit, p.x, n.x, wide, 0, box);
    add_half_balls(lit, p.y, n.y, wide, 1, box);
    add_half_balls(lit, p.z, n.z, wide, 2, box);
  }
}

// Appends the hits of rays k of a row.
CLPV_INLINE void add_hits(const NearRow r, const uint k, const float8 reach, const Rays* rays, __global float* list,
                          uint* count) {
  const uint bits = clpv_bits(vload8(0, rays->distance) < reach);
  for (uint rest = bits; rest != 0; rest &= rest - 1u) {
    const uint i = clpv_lowest(rest);
    __global float* hit = list + *count / CLPV_ABREAST * CLPV_HIT_ROWS * CLPV_ABREAST + *count % CLPV_ABREAST;
    hit[CLPV_HIT_U * CLPV_ABREAST] = rays->u[i];
    hit[CLPV_HIT_V * CLPV_ABREAST] = rays->v[i];
    hit[CLPV_HIT_DISTANCE * CLPV_ABREAST] = rays->distance[i];
    hit[CLPV_HIT_TRIANGLE * CLPV_ABREAST] = as_float(rays->triangle[i]);
    hit[CLPV_HIT_PIXEL * CLPV_ABREAST] = as_float(r.at + i);
    hit[CLPV_HIT_RADIANCE * CLPV_ABREAST] = as_float(3u * k * r.plane + r.at + i);
    ++*count;
  }
}

__kernel void near_trace(const ClpvView view, __global const float* points, __global const float8* directions,
                         __global const float8* nodes, __global const float8* leaves, CLPV_SCENE,
                         __global float* distances, __global uint* counts, __global float* hits) {
  const uint tile = near_tile(view);
  if (tile == CLPV_NO_TILE) return;
  const Tree tree = {nodes, leaves};
  Box box;
  box_of_tile(view, points, &box);
  Entry entry;
  clpv_enter(tree, box, &entry);
  __global float* list = hits + (size_t)tile * CLPV_TILE_HITS * CLPV_HIT_ROWS;
  uint count = 0;
  for (int y = 0; y < CLPV_NEAR_TILE; ++y) {
    const NearRow r = near_row(view, get_global_id(0), get_global_id(1) * CLPV_NEAR_TILE + y);
    if (!near_inside(r)) continue;
    NearPoints p;
    near_points_at(points, r, &p);
    const Vec from = vec_add_scaled(p.position, CLPV_NEAR_LIFT * p.reach, p.normal);
    for (uint k = 0; k < CLPV_NEAR_RAYS; ++k) {
      Rays rays;
      clpv_set_rays(from, near_directions(directions, r, &p, k), p.reach, &rays);
      clpv_nearest_triangles(tree, &entry, CLPV_PASS_SCENE, &rays);
      const float8 distance = vload8(0, rays.distance);
      vstore8(distance < p.reach ? distance : (float8)(INFINITY), 0, distances + k * r.plane + r.at);
      add_hits(r, k, p.reach, &rays, list, &count);
    }
  }
  counts[tile] = count;
}
