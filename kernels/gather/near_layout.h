// SPDX-License-Identifier: MIT
// Pixels of the near field, in planes of numbers with an empty border (shared/near.h), and the directions of their rays.
//
// A block of CLPV_NEAR_STEP x CLPV_NEAR_STEP pixels of the camera has a pixel in each of two layers, the second layer
// below the first. The first has the block's first pixel; the second has one whose surface the first layer has not
// there, or is empty (near_points.cl).
//
// From the host: CLPV_NEAR_STEP (1, 2, 4 or 8), CLPV_NEAR_LAYERS (1 or 2), CLPV_NEAR_RAYS (rays per pixel).
#pragma once

#include "lanes.h"
#include "shared/near.h"
#include "shared/view.h"
#include "vec.h"

// W pixels of a row.
typedef struct {
  uint width, height, pitch, plane;  // of both layers: pixels, and numbers of a row and of a plane
  int x, y;                          // first pixel; may be in the border
  uint at;                           // its index in a plane
} NearRow;

static inline uint near_pixels(const uint pixels) {
  return (pixels + CLPV_NEAR_STEP - 1) / CLPV_NEAR_STEP;
}

// First row of the second layer, and the number of rows of all layers.
static inline uint near_second(const ClpvView view) {
  return CLPV_NEAR_SECOND_OF(near_pixels(view.height));
}
static inline uint near_rows(const ClpvView view) {
  const uint height = near_pixels(view.height);
  return CLPV_NEAR_LAYERS == 1 ? height : CLPV_NEAR_SECOND_OF(height) + height;
}
static inline uint near_plane(const ClpvView view) {
  return CLPV_NEAR_PLANE_OF(near_pixels(view.width), near_rows(view));
}

// The pixels from (W column, row) on.
static inline NearRow find_near_row(const ClpvView view, const int column, const int row) {
  NearRow r;
  r.width = near_pixels(view.width);
  r.height = near_rows(view);
  r.pitch = CLPV_NEAR_PITCH_OF(r.width);
  r.plane = near_plane(view);
  r.x = column * W;
  r.y = row;
  r.at = (uint)(row + CLPV_NEAR_ROWS) * r.pitch + (uint)(r.x + CLPV_NEAR_COLUMNS);
  return r;
}

// True if a row has pixels.
static inline bool row_has_pixels(const NearRow r) {
  return r.x < (int)r.width && r.y < (int)r.height;
}

// Tile of W x CLPV_NEAR_TILE pixels of this work-item.
#define CLPV_NO_TILE 0xffffffffu
static inline uint find_near_tile(const ClpvView view) {
  const uint across = (near_pixels(view.width) + W - 1) / W,
             down = (near_rows(view) + CLPV_NEAR_TILE - 1) / CLPV_NEAR_TILE,
             x = get_global_id(0), y = get_global_id(1);
  return x < across && y < down ? y * across + x : CLPV_NO_TILE;
}

// Largest number of hits of a tile. They lie in groups of W, whose numbers have rows (shared/near.h).
#define CLPV_TILE_HITS (W * CLPV_NEAR_TILE * CLPV_NEAR_RAYS)

// Vectors from three planes.
CLPV_INLINE Vec load_near_vectors(__global const float* planes, const uint plane, const uint at) {
  return vec(load_lanes(planes + at), load_lanes(planes + plane + at), load_lanes(planes + 2 * plane + at));
}
CLPV_INLINE void store_near_vectors(const Vec v, __global float* planes, const uint plane, const uint at) {
  store_lanes(v.x, planes + at);
  store_lanes(v.y, planes + plane + at);
  store_lanes(v.z, planes + 2 * plane + at);
}

// Points of W pixels.
typedef struct {
  Vec position, normal, tangent, bitangent;
  realW reach;
} NearPoints;

// Loads points. The tangents make an orthonormal frame without a branch (Duff et al., 'Building an Orthonormal Basis,
// Revisited', JCGT 6(1), 2017).
CLPV_INLINE void load_near_points(__global const float* points, const NearRow r, NearPoints* p) {
  p->position = load_near_vectors(points + CLPV_NEAR_POSITION * r.plane, r.plane, r.at);
  p->normal = load_near_vectors(points + CLPV_NEAR_NORMAL * r.plane, r.plane, r.at);
  p->reach = load_lanes(points + CLPV_NEAR_REACH * r.plane + r.at);
  const Vec n = p->normal;
  const realW sign = n.z < ZERO ? -ONE : ONE;
  const realW a = -1.0f / (sign + n.z), b = n.x * n.y * a;
  p->tangent = vec(1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x);
  p->bitangent = vec(b, sign + n.y * n.y * a, -n.y);
}

// Numbers of a row of `directions`, and vectors.
#define CLPV_DIRECTIONS 8
#define CLPV_DIRECTION_VECTORS (CLPV_DIRECTIONS / W)

// Unit directions of ray k of W pixels. `directions`: about +z, by row of the tile, ray and axis; the four pixels of
// a tile's row twice.
CLPV_INLINE Vec find_near_directions(__global const realW* directions, const NearRow r, const NearPoints* p, const uint k) {
  const uint row = ((uint)r.y % CLPV_NEAR_TILE * CLPV_NEAR_RAYS + k) * 3 * CLPV_DIRECTION_VECTORS;
  __global const realW* about_z = directions + row + (uint)r.x % CLPV_DIRECTIONS / W;
  const Vec w = vec(about_z[0], about_z[CLPV_DIRECTION_VECTORS], about_z[2 * CLPV_DIRECTION_VECTORS]);
  return vec_blend(w, p->tangent, p->bitangent, p->normal);
}
