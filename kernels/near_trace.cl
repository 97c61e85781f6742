// SPDX-License-Identifier: MIT
// Traces the rays of the near field against the scene's triangles.
//
// In:   points, directions   near_layout.h
//       nodes, leaves        tree of the triangles (triangle_tree.h); CLPV_SCENE: the scene, for masked materials
// Out:  distances            per ray: distance of the hit [m], INFINITY without one; a plane for each k
//       places               weights u and v of the hit's triangle, and the triangle (uint); three planes for each k
// A work-item traces the rays k of eight pixels of a row.
#include "near_layout.h"
#include "tile_row.h"
#include "triangle_tree.h"

__kernel void near_trace(const ClpvView view, __global const float* points, __global const float8* directions,
                         __global const float8* nodes, __global const float8* leaves, CLPV_SCENE,
                         __global float* distances, __global float* places) {
  const NearRow r = near_row(view, get_global_id(0), get_global_id(1));
  const uint k = get_global_id(2);
  if (!near_inside(r)) return;
  NearPoints p;
  near_points_at(points, r, &p);
  const Tree tree = {nodes, leaves};
  const int8 lit = p.reach > (float8)(0.0f);
  const VecLanes from = unpack(lit, vec_add_scaled(p.position, CLPV_NEAR_LIFT * p.reach, p.normal));
  const VecLanes along = unpack(lit, near_directions(directions, r, &p, k));
  float reach[CLPV_ABREAST];
  vstore8(p.reach, 0, reach);
  distances += k * r.plane + r.at;
  places += 3 * k * r.plane + r.at;
  for (int i = 0; i < CLPV_ABREAST; ++i) {
    Hit hit = {reach[i], 0.0f, 0.0f, 0u};
    bool met = false;
    if (reach[i] > 0.0f) {
      Ray ray;
      clpv_make_ray(from.x[i], from.y[i], from.z[i], along.x[i], along.y[i], along.z[i], &ray);
      met = clpv_nearest_triangle(tree, &ray, CLPV_PASS_SCENE, &hit);
    }
    distances[i] = met ? hit.distance : INFINITY;
    places[i] = hit.u;
    places[r.plane + i] = hit.v;
    places[2 * r.plane + i] = as_float(hit.triangle);
  }
}
