// SPDX-License-Identifier: MIT
// Which triangle each pixel sees, and how far away it is: the depth test of all that rasterize.cl listed over a tile.
// One work-item a tile. A pixel keeps the least key and, among equal ones, the least triangle, so that the order of
// the lists does not matter.
//
// keys and seen hold a float8 and uint8 a row of a tile, CLPV_TILE rows a tile, tiles row by row; empty pixels are
// INFINITY and UINT_MAX. `fresh`: onto nothing, else onto what they hold.
#include "edges.h"
#include "lanes.h"
#include "texture.h"
#include "tile_row.h"
#include "triangle.h"

typedef struct {
  __global const ClpvVertex* vertices;
  __global const ClpvTriangle* triangles;
  __global const ClpvMaterial* materials;
  __global const float4* textures;
  __global const uint* texels;
} Scene;

static inline float8 blended(const Vec w, const float a, const float b, const float c) {
  return w.x * a + w.y * b + w.z * c;
}

// In which lanes the surface of a triangle of a masked material, `depth` behind the pixels from (px, py) on, is there
// rather than a hole.
CLPV_INLINE int8 solid(const ClpvView view, const uint triangle, const float px, const float py,
                       const float8 depth, const Scene scene) {
  const ClpvTriangle t = scene.triangles[triangle];
  __global const ClpvMaterial* material = scene.materials + t.material;
  __global const ClpvVertex* a = scene.vertices + t.vertex[0];
  __global const ClpvVertex* b = scene.vertices + t.vertex[1];
  __global const ClpvVertex* c = scene.vertices + t.vertex[2];
  const Face face = clpv_face(view, vec_load(a->position), vec_load(b->position), vec_load(c->position));
  const float8 x = px + (float8)(0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f);
  const Vec w = clpv_weights_at(view, face, clpv_weights(face), x, (float8)(py), depth);
  const Uv uv = {blended(w, a->uv[0], b->uv[0], c->uv[0]), blended(w, a->uv[1], b->uv[1], c->uv[1])};
  const uint8 finest = (uint8)(material->texture * CLPV_TEXTURE_LEVELS);
  const float8 alpha = material->base_colour[3] * blended(w, a->colour[3], b->colour[3], c->colour[3]) *
                       clpv_bilinear_alpha(scene.textures, scene.texels, finest, uv);
  return alpha >= material->alpha_cutoff;
}

// Which pixels of a tile's rows `top` to `bottom` a triangle covers; (px, py) is the tile's first pixel. Out of line:
// large triangles are few, and this would take the registers that small ones need.
__attribute__((noinline)) void cover_by_large(__global const ClpvRasterTriangle* r, const int px,
                                              const int py, const int top, const int bottom, int8* covered) {
  const long8 lane = (long8)(0, 1, 2, 3, 4, 5, 6, 7);
  const Edge e0 = edge_at(r, 0, px, py + top), e1 = edge_at(r, 1, px, py + top),
             e2 = edge_at(r, 2, px, py + top);
  long8 v0 = e0.value + lane * e0.step_x, v1 = e1.value + lane * e1.step_x, v2 = e2.value + lane * e2.step_x;
  for (int row = top; row <= bottom; ++row) {
    covered[row] = convert_int8((v0 | v1 | v2) >= 0L);
    v0 += e0.step_y;
    v1 += e1.step_y;
    v2 += e2.step_y;
  }
}

// The same for a small triangle: 32 bits do, and the three edges are set up together.
static inline void cover_by_small(__global const ClpvRasterTriangle* r, const int px, const int py,
                                  const int top, const int bottom, int8* covered) {
  const int8 lane = (int8)(0, 1, 2, 3, 4, 5, 6, 7);
  const int4 x = vload4(0, r->x), y = vload4(0, r->y);
  const int4 dx = x.yzwx - x, dy = y.yzwx - y;
  const int4 top_left = (dy < 0) | ((dy == 0) & (dx > 0));
  const int4 to_x = px * CLPV_SUBPIXELS + CLPV_SUBPIXELS / 2 - x;
  const int4 to_y = (py + top) * CLPV_SUBPIXELS + CLPV_SUBPIXELS / 2 - y;
  const int4 value = dx * to_y - dy * to_x - 1 - top_left;
  const int4 step_x = -dy * CLPV_SUBPIXELS, step_y = dx * CLPV_SUBPIXELS;
  int8 v0 = value.x + step_x.x * lane, v1 = value.y + step_x.y * lane, v2 = value.z + step_x.z * lane;
  for (int row = top; row <= bottom; ++row) {
    covered[row] = (v0 | v1 | v2) >= 0;
    v0 += step_y.x;
    v1 += step_y.y;
    v2 += step_y.z;
  }
}

// The farthest key of a tile's pixels.
static inline float farthest_of(__global const float8* keys) {
  float8 most = keys[0];
  for (int row = 1; row < CLPV_TILE; ++row) most = keys[row] > most ? keys[row] : most;
  const float4 four = most.lo > most.hi ? most.lo : most.hi;
  const float2 two = four.lo > four.hi ? four.lo : four.hi;
  return two.x > two.y ? two.x : two.y;
}

__kernel void draw_tiles(const ClpvView view, const uint fresh, __global const ClpvRasterTriangle* list,
                         __global const uint* starts, __global const uint2* binned,
                         __global const ClpvVertex* vertices, __global const ClpvTriangle* triangles,
                         __global const ClpvMaterial* materials, __global const float4* textures,
                         __global const uint* texels, __global float8* keys, __global uint8* seen) {
  const uint tiles_x = (view.width + CLPV_TILE - 1) / CLPV_TILE, x = get_global_id(0), y = get_global_id(1);
  if (x >= tiles_x || y * CLPV_TILE >= view.height) return;
  const uint tile = y * tiles_x + x;
  const int tile_x = (int)x * CLPV_TILE, tile_y = (int)y * CLPV_TILE;
  const Scene scene = {vertices, triangles, materials, textures, texels};
  const float far_key = CLPV_ORTHOGRAPHIC ? view.far_depth : -1.0f / view.far_depth;
  __global float8* tile_keys = keys + tile * CLPV_TILE;
  __global uint8* tile_seen = seen + tile * CLPV_TILE;
  if (fresh) {
    for (int row = 0; row < CLPV_TILE; ++row) {
      tile_keys[row] = (float8)(INFINITY);
      tile_seen[row] = (uint8)(UINT_MAX);
    }
  }
  const float8 column = (float8)(0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f);
  int8 covered[CLPV_TILE];
  const uint end = starts[tile + 1];
  float hidden = farthest_of(tile_keys);  // what lies beyond is not seen
  for (uint i = starts[tile]; i < end; ++i) {
    if (as_float(binned[i].y) > hidden) continue;
    __global const ClpvRasterTriangle* r = list + binned[i].x;
    const uint triangle = r->triangle & CLPV_TRIANGLE_INDEX;
    const bool masked = (r->triangle & CLPV_TRIANGLE_MASKED) != 0;
    const int first_x = (int)(r->first & 0xffffu), first_y = (int)(r->first >> 16);
    const int top = max(first_y - tile_y, 0), bottom = min((int)(r->last >> 16) - tile_y, CLPV_TILE - 1);
    if (r->triangle & CLPV_TRIANGLE_SMALL) {
      cover_by_small(r, tile_x, tile_y, top, bottom, covered);
    } else {
      cover_by_large(r, tile_x, tile_y, top, bottom, covered);
    }
    const float8 key_left = r->key + r->key_x * (column + (float)(tile_x - first_x));
    const float8 nearest = (float8)(r->nearest), farthest = (float8)(r->farthest);
    const float key_y = r->key_y;
    for (int row = top; row <= bottom; ++row) {
      float8 key = key_left + key_y * (float)(tile_y + row - first_y);
      key = key > nearest ? key : nearest;
      key = key < farthest ? key : farthest;
      const float8 old = tile_keys[row];
      const uint8 old_seen = tile_seen[row];
      int8 closer = covered[row] & (key <= far_key) & ((key < old) | ((key == old) & (triangle < old_seen)));
      if (masked) {
        if (none(closer)) continue;
        const float8 depth = CLPV_ORTHOGRAPHIC ? key : -1.0f / key;
        closer &= solid(view, triangle, (float)tile_x, (float)(tile_y + row), depth, scene);
      }
      tile_keys[row] = select(old, key, closer);
      tile_seen[row] = select(old_seen, (uint8)(triangle), closer);
    }
    hidden = farthest_of(tile_keys);
  }
}

// Depths alone: a shadow map. One work-item a row of a tile.
__kernel void resolve_depth(const ClpvView view, __global const float8* keys, __global float* depths) {
  const Eight p = this_row(view);
  if (p.count == 0) return;
  store_depth(view, p, keys[p.row], depths);
}
