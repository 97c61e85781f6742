// SPDX-License-Identifier: MIT
// Pixels of the near field (pixel_planes.h): their points, the directions of their rays, and lists
// of hits.
//
// Layer 1 holds the first pixel of each block. Layer 2 holds a pixel of the block whose surface
// layer 1 lacks there, or nothing (near_points.cl).
//
// From the host: CLPV_NEAR_RAYS (rays per pixel).
#pragma once

#include "gather/pixel_planes.h"
#include "raster/geometric_normal.h"
#include "shared/near.h"

// Tile of W x CLPV_PLANE_TILE pixels of this work-item.
__constant const uint no_tile = 0xffffffffu;
static inline uint find_near_tile(const ClpvView view) {
  const uint across = (plane_pixels(view.width) + W - 1) / W,
             down = (plane_rows(view) + CLPV_PLANE_TILE - 1) / CLPV_PLANE_TILE,
             x = get_global_id(0), y = get_global_id(1);
  return x < across && y < down ? y * across + x : no_tile;
}

// Largest number of hits of a tile. Hits are stored in groups of W, one row per attribute
// (shared/near.h).
// With one lane each ray has its own slot and count: 1 with a hit, else 0.
enum { CLPV_TILE_HITS = W * CLPV_PLANE_TILE * CLPV_NEAR_RAYS };
static inline uint first_slot(const uint tile) {
  return W > 1 ? tile * CLPV_TILE_HITS : tile * CLPV_TILE_HITS + (uint)get_global_id(2);
}
static inline uint count_index(const uint tile) { return W > 1 ? tile : first_slot(tile); }

// Points of W pixels.
typedef struct {
  Vec position, normal, lift, tangent, bitangent;
  realW reach;
} NearPoints;

// Loads points. The tangents make an orthonormal frame without a branch (Duff et al., 'Building an
// Orthonormal Basis, Revisited', JCGT 6(1), 2017).
CLPV_INLINE void load_near_points(__global const float* points, const PlaneRow r, NearPoints* p) {
  p->position = load_plane_vectors(points + CLPV_NEAR_POSITION * r.plane, r.plane, r.at);
  p->normal = load_plane_vectors(points + CLPV_NEAR_NORMAL * r.plane, r.plane, r.at);
  p->reach = load_lanes(points + CLPV_NEAR_REACH * r.plane + r.at);
  const realW geometric = load_lanes(points + CLPV_NEAR_GEOMETRIC * r.plane + r.at);
  p->lift = lift_normal(unpack_geometric_normal(geometric, p->normal), p->normal);
  const Vec n = p->normal;
  const realW sign = n.z < ZERO ? -ONE : ONE;
  const realW a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  p->tangent = vec(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
  p->bitangent = vec(b, sign + n.y * n.y * a, -n.y);
}

// Numbers of a row of `directions`, and vectors.
enum {
  CLPV_DIRECTIONS = 8,
  CLPV_DIRECTION_VECTORS = CLPV_DIRECTIONS / W,
};

// Unit directions of ray k of W pixels. `directions`: vectors about +z, indexed by tile row, ray
// and axis; each row repeats the tile's four pixels, to fill eight lanes.
CLPV_INLINE Vec find_near_directions(__global const realW* directions, const PlaneRow r,
                                     const NearPoints* p, const uint k) {
  const uint row = ((uint)r.y % CLPV_PLANE_TILE * CLPV_NEAR_RAYS + k) * 3 * CLPV_DIRECTION_VECTORS;
  __global const realW* about_z = directions + row + (uint)r.x % CLPV_DIRECTIONS / W;
  const Vec w =
      vec(about_z[0], about_z[CLPV_DIRECTION_VECTORS], about_z[2 * CLPV_DIRECTION_VECTORS]);
  return vec_blend(w, p->tangent, p->bitangent, p->normal);
}
