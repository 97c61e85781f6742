// SPDX-License-Identifier: MIT
// Traces the rays of the near field against the scene's triangles.
//
// In:   points, directions   near_layout.h
//       nodes, leaves        tree of the triangles (gather/triangle_tree.h); CLPV_SCENE: the scene,
//                            for masked materials
// Out:  distances            per ray: distance of the hit [m], INFINITY without one; a plane for
//                            each k
//       counts, hits         per tile: number of hits, and their list (near_layout.h)
// With eight lanes a work-item traces the rays of a tile, which start from the same subtrees
// (tree_lists.h); with one lane a ray.
#include "gather/near_layout.h"
#if W == 1
#include "gather/tree_stack.h"
#else
#include "gather/tree_lists.h"

// Widens the bounds along an axis by half balls of radius `reach` about W points.
CLPV_INLINE void add_half_balls(const intW lit, const realW at, const realW normal,
                                const realW reach, const int axis, Box* box) {
  const realW square = 1.0f - normal * normal, sine = sqrt(square > ZERO ? square : ZERO);
  const realW before = normal > ZERO ? sine : ONE, after = normal < ZERO ? sine : ONE;
  const realW far = (realW)(CLPV_TREE_FAR);
  const float lower = min_lane(lit ? at - before * reach : far),
              upper = -min_lane(lit ? -(at + after * reach) : far);
  box->lower[axis] = lower < box->lower[axis] ? lower : box->lower[axis];
  box->upper[axis] = upper > box->upper[axis] ? upper : box->upper[axis];
}

// Box about the rays of a tile.
CLPV_INLINE void box_of_tile(const ClpvView view, __global const float* points, Box* box) {
  for (int axis = 0; axis < 3; ++axis)
    box->lower[axis] = CLPV_TREE_FAR, box->upper[axis] = -CLPV_TREE_FAR;
  for (int y = 0; y < CLPV_PLANE_TILE; ++y) {
    const PlaneRow r =
        find_plane_row(view, get_global_id(0), get_global_id(1) * CLPV_PLANE_TILE + y);
    if (!row_has_pixels(r)) continue;
    const Vec p = load_plane_vectors(points + CLPV_NEAR_POSITION * r.plane, r.plane, r.at);
    const Vec n = load_plane_vectors(points + CLPV_NEAR_NORMAL * r.plane, r.plane, r.at);
    const realW reach = load_lanes(points + CLPV_NEAR_REACH * r.plane + r.at);
    const intW lit = reach > ZERO;
    const realW wide = reach * (1.0f + 2.0f * CLPV_NEAR_LIFT);
    add_half_balls(lit, p.x, n.x, wide, 0, box);
    add_half_balls(lit, p.y, n.y, wide, 1, box);
    add_half_balls(lit, p.z, n.z, wide, 2, box);
  }
}

#endif

// Appends the hits of rays k of a row.
CLPV_INLINE void add_hits(const PlaneRow r, const uint k, const realW reach, const Rays* rays,
                          __global float* list, uint* count) {
  const uint bits = lane_bits(load_lanes(rays->distance) < reach);
  for (uint rest = bits; rest != 0; rest &= rest - 1u) {
    const uint i = lowest_bit(rest);
    __global float* hit = list + *count / W * CLPV_HIT_ROWS * W + *count % W;
    hit[CLPV_HIT_U * W] = rays->u[i];
    hit[CLPV_HIT_V * W] = rays->v[i];
    hit[CLPV_HIT_DISTANCE * W] = rays->distance[i];
    hit[CLPV_HIT_TRIANGLE * W] = as_float(rays->triangle[i]);
    hit[CLPV_HIT_PIXEL * W] = as_float(r.at + i);
    hit[CLPV_HIT_RADIANCE * W] = as_float(3u * k * r.plane + r.at + i);
    ++*count;
  }
}

#if W == 1
__attribute__((reqd_work_group_size(CLPV_STACK_SIDE, CLPV_STACK_SIDE, 1)))
#endif
__kernel void near_trace(const ClpvView view, __global const float* points,
                         __global const realW* directions, __global const realW* nodes,
                         __global const realW* leaves, CLPV_SCENE, __global float* distances,
                         __global uint* counts, __global float* hits) {
#if W == 1
  __local uint stacked_nodes[CLPV_STACKS];
  __local uchar stacked_children[CLPV_STACKS];
  const uint item = get_local_id(1) * CLPV_STACK_SIDE + get_local_id(0);
  const Stack stack = {stacked_nodes + item, stacked_children + item};
#endif
  const uint tile = find_near_tile(view);
  if (tile == no_tile) return;
  const Tree tree = {nodes, leaves};
#if W > 1
  Box box;
  box_of_tile(view, points, &box);
  Entry entry;
  enter_tree(tree, box, &entry);
#endif
  __global float* list = hits + (size_t)first_slot(tile) * CLPV_HIT_ROWS;
  uint count = 0;
  const uint ray = W > 1 ? 0 : get_global_id(2), first_y = ray / CLPV_NEAR_RAYS,
             rows = W > 1 ? CLPV_PLANE_TILE : 1, first_k = ray % CLPV_NEAR_RAYS,
             rays_of_row = W > 1 ? CLPV_NEAR_RAYS : 1;
  for (uint y = first_y; y < first_y + rows; ++y) {
    const PlaneRow r =
        find_plane_row(view, get_global_id(0), get_global_id(1) * CLPV_PLANE_TILE + y);
    if (!row_has_pixels(r)) continue;
    NearPoints p;
    load_near_points(points, r, &p);
    if (no_lane(p.reach > ZERO)) continue;
    const Vec from = vec_add_scaled(p.position, CLPV_NEAR_LIFT * p.reach, p.lift);
    for (uint k = first_k; k < first_k + rays_of_row; ++k) {
      Rays rays;
      set_rays(from, find_near_directions(directions, r, &p, k), p.reach, &rays);
#if W > 1
      trace_rays(tree, &entry, CLPV_PASS_SCENE, &rays);
#else
      trace_ray(tree, stack, CLPV_PASS_SCENE, &rays);
#endif
      const realW distance = load_lanes(rays.distance);
      store_lanes(distance < p.reach ? distance : (realW)(INFINITY),
                  distances + k * r.plane + r.at);
      add_hits(r, k, p.reach, &rays, list, &count);
    }
  }
  counts[count_index(tile)] = count;
}
