// Rasterises the scene's triangles into a view: which triangle each pixel sees, and how far away it is.
//
//   project_vertices   every vertex onto the screen, snapped to 1/256 pixel
//   set_up             triangles that may cover a pixel's centre -> a list of ClpvRasterTriangle
//   set_up_clipped     the same for those that cross the near plane or the guard band
//   bin_triangles      counts, then lists, the triangles over each tile of 8 x 8 pixels
//   draw_tiles         one work-item a tile: depth test of everything over it
//
// Lists are in no particular order (atomics hand out their places); the result does not depend on it, since a
// pixel keeps the least key and, among equal ones, the least triangle. What a pixel looks like is
// resolve.cl's task.
#include "clip.h"
#include "texture.h"

// Bits of a vertex: outside which borders of the view it is.
static inline uint where_is(const ClpvView view, const float4 p) {
  const float2 guard = clpv_guard(view);
  const float2 border = (float2)(view.half_width, view.half_height) * p.z;
  uint where = 0;
  if (p.x < -border.x) where |= CLPV_LEFT;
  if (p.x > border.x) where |= CLPV_RIGHT;
  if (p.y > border.y) where |= CLPV_ABOVE;
  if (p.y < -border.y) where |= CLPV_BELOW;
  if (p.w > view.far_depth) where |= CLPV_BEYOND;
  if (!CLPV_ORTHOGRAPHIC && p.w < view.near_depth) where |= CLPV_BEHIND;
  if (!(fabs(p.x) <= guard.x * p.z && fabs(p.y) <= guard.y * p.z)) where |= CLPV_OUT_OF_GUARD;
  return where;
}

__kernel void project_vertices(const ClpvView view, const uint count, __global const ClpvVertex* vertices,
                               __global ClpvProjected* projected) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const float4 p = clpv_view_point(view, vertices + i);
  const uint where = where_is(view, p);
  ClpvProjected result = {0, 0, 0.0f, 0};
  if ((where & CLPV_NEEDS_CLIPPING) == 0) result = clpv_project(view, p);
  result.where = where;
  projected[i] = result;
}

// Twice the signed area in squared sub-pixels; positive: clockwise on the screen, where y points down.
static inline long screen_area(const ClpvProjected a, const ClpvProjected b, const ClpvProjected c) {
  return (long)(b.x - a.x) * (c.y - a.y) - (long)(c.x - a.x) * (b.y - a.y);
}

// First pixel whose centre is at or after a sub-pixel coordinate, last one whose centre is at or before it.
static inline int first_centre(const int at) {
  return (at + CLPV_SUBPIXELS / 2 - 1) >> 8;
}
static inline int last_centre(const int at) {
  return (at - CLPV_SUBPIXELS / 2) >> 8;
}

// Appends a triangle of the screen to the list, unless it covers no pixel's centre or shows its culled back.
// A count beyond `capacity` tells the host how many there are.
static inline void append(const ClpvView view, const ClpvProjected a, ClpvProjected b, ClpvProjected c,
                          const Face face, const uint triangle, const uint flags, const uint cull,
                          volatile __global uint* count, const uint capacity,
                          __global ClpvRasterTriangle* list) {
  const long area = screen_area(a, b, c);
  if (area == 0 || (area > 0 && cull && !(flags & CLPV_MATERIAL_DOUBLE_SIDED))) return;
  const int left = max(first_centre(min(a.x, min(b.x, c.x))), 0);
  const int top = max(first_centre(min(a.y, min(b.y, c.y))), 0);
  const int right = min(last_centre(max(a.x, max(b.x, c.x))), (int)view.width - 1);
  const int bottom = min(last_centre(max(a.y, max(b.y, c.y))), (int)view.height - 1);
  if (left > right || top > bottom) return;
  const uint at = atomic_inc(count);
  if (at >= capacity) return;
  if (area < 0) {
    const ClpvProjected swapped = b;
    b = c;
    c = swapped;
  }
  ClpvRasterTriangle r;
  r.x[0] = a.x, r.x[1] = b.x, r.x[2] = c.x;
  r.y[0] = a.y, r.y[1] = b.y, r.y[2] = c.y;
  r.nearest = fmin(a.key, fmin(b.key, c.key));
  r.farthest = fmax(a.key, fmax(b.key, c.key));
  const Vec plane = clpv_key_plane(view, face, (float)left, (float)top);
  const bool edge_on = !isfinite(plane.x) || !isfinite(plane.y) || !isfinite(plane.z);
  r.key = edge_on ? r.nearest : plane.x;
  r.key_x = edge_on ? 0.0f : plane.y;
  r.key_y = edge_on ? 0.0f : plane.z;
  r.first = (uint)left + ((uint)top << 16);
  r.last = (uint)right + ((uint)bottom << 16);
  r.triangle = triangle;
  r.masked = flags & CLPV_MATERIAL_MASKED;
  r.unused = 0;
  list[at] = r;
}

// counts[0]: triangles listed; counts[1]: triangles to clip.
__kernel void set_up(const ClpvView view, const uint first, const uint count, const uint cull,
                     __global const ClpvVertex* vertices, __global const ClpvTriangle* triangles,
                     __global const ClpvMaterial* materials, __global const ClpvProjected* projected,
                     volatile __global uint* counts, const uint capacity, __global ClpvRasterTriangle* list,
                     __global uint* to_clip) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const ClpvTriangle t = triangles[first + i];
  const ClpvProjected a = projected[t.vertex[0]], b = projected[t.vertex[1]], c = projected[t.vertex[2]];
  if (a.where & b.where & c.where & CLPV_OUT_OF_SIGHT) return;
  if ((a.where | b.where | c.where) & CLPV_NEEDS_CLIPPING) {
    to_clip[atomic_inc(counts + 1)] = first + i;
    return;
  }
  append(view, a, b, c,
         clpv_face(view, vertices + t.vertex[0], vertices + t.vertex[1], vertices + t.vertex[2]), first + i,
         materials[t.material].flags, cull, counts, capacity, list);
}

__kernel void set_up_clipped(const ClpvView view, const uint count, const uint cull,
                             __global const ClpvVertex* vertices, __global const ClpvTriangle* triangles,
                             __global const ClpvMaterial* materials, volatile __global uint* counts,
                             const uint capacity, __global ClpvRasterTriangle* list,
                             __global const uint* to_clip) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const uint triangle = to_clip[i];
  const ClpvTriangle t = triangles[triangle];
  float4 polygon[CLPV_CLIP_CORNERS];
  for (int k = 0; k < 3; ++k) polygon[k] = clpv_view_point(view, vertices + t.vertex[k]);
  const int corners = clpv_clip(view, polygon);
  const Face face = clpv_face(view, vertices + t.vertex[0], vertices + t.vertex[1], vertices + t.vertex[2]);
  const ClpvProjected apex = clpv_project(view, polygon[0]);
  for (int k = 2; k < corners; ++k) {
    append(view, apex, clpv_project(view, polygon[k - 1]), clpv_project(view, polygon[k]), face, triangle,
           materials[t.material].flags, cull, counts, capacity, list);
  }
}

// An edge function: not negative at the pixel centres on the inner side of the edge from corner i to corner
// j, exactly. Centres on the edge itself belong to it if it is a top or a left edge, so to one of the two
// triangles that share it.
typedef struct {
  long value;           // at the centre of a pixel
  long step_x, step_y;  // from a pixel to the next one right, and below
} Edge;

static inline Edge edge_at(const ClpvRasterTriangle r, const int i, const int j, const int px, const int py) {
  const int dx = r.x[j] - r.x[i], dy = r.y[j] - r.y[i];
  const int x = px * CLPV_SUBPIXELS + CLPV_SUBPIXELS / 2, y = py * CLPV_SUBPIXELS + CLPV_SUBPIXELS / 2;
  const bool top_left = dy < 0 || (dy == 0 && dx > 0);
  Edge edge;
  edge.value = (long)dx * (y - r.y[i]) - (long)dy * (x - r.x[i]) - (top_left ? 0 : 1);
  edge.step_x = -(long)dy * CLPV_SUBPIXELS;
  edge.step_y = (long)dx * CLPV_SUBPIXELS;
  return edge;
}

// The largest value the edge function takes in a tile, `edge` being at its upper left pixel.
static inline long largest_in_tile(const Edge edge) {
  return edge.value + (CLPV_TILE - 1) * (max(edge.step_x, 0L) + max(edge.step_y, 0L));
}

// One work-item a listed triangle. `fill` 0: counts the tiles it is over in places[tile]; 1: places[tile] is
// where the tile's next triangle goes in `binned`, and is advanced.
__kernel void bin_triangles(const uint count, const uint tiles_x, const uint fill,
                            __global const ClpvRasterTriangle* list, volatile __global uint* places,
                            __global uint* binned) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const ClpvRasterTriangle r = list[i];
  const int left = (int)(r.first & 0xffffu) / CLPV_TILE, right = (int)(r.last & 0xffffu) / CLPV_TILE;
  const int top = (int)(r.first >> 16) / CLPV_TILE, bottom = (int)(r.last >> 16) / CLPV_TILE;
  const Edge e0 = edge_at(r, 0, 1, left * CLPV_TILE, top * CLPV_TILE);
  const Edge e1 = edge_at(r, 1, 2, left * CLPV_TILE, top * CLPV_TILE);
  const Edge e2 = edge_at(r, 2, 0, left * CLPV_TILE, top * CLPV_TILE);
  const bool one_tile = left == right && top == bottom;
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const long dx = CLPV_TILE * (x - left), dy = CLPV_TILE * (y - top);
      const long inside = (largest_in_tile(e0) + dx * e0.step_x + dy * e0.step_y) |
                          (largest_in_tile(e1) + dx * e1.step_x + dy * e1.step_y) |
                          (largest_in_tile(e2) + dx * e2.step_x + dy * e2.step_y);
      if (inside < 0 && !one_tile) continue;
      const uint at = atomic_inc(places + (uint)y * tiles_x + (uint)x);
      if (fill) binned[at] = i;
    }
  }
}

// Whether the surface at `key` behind a pixel is there or cut away.
static bool is_solid(const ClpvView view, const uint triangle, const int px, const int py, const float key,
                     __global const ClpvVertex* vertices, __global const ClpvTriangle* triangles,
                     __global const ClpvMaterial* materials, __global const ClpvTexture* textures,
                     __global const uint* texels) {
  const ClpvTriangle t = triangles[triangle];
  __global const ClpvMaterial* material = materials + t.material;
  __global const ClpvVertex* a = vertices + t.vertex[0];
  __global const ClpvVertex* b = vertices + t.vertex[1];
  __global const ClpvVertex* c = vertices + t.vertex[2];
  const Face face = clpv_face(view, a, b, c);
  const float depth = CLPV_ORTHOGRAPHIC ? key : -1.0f / key;
  const Vec w = clpv_weights_at(view, face, clpv_weights(face), (float)px, (float)py, depth);
  float alpha = material->base_colour[3] * (w.x * a->colour[3] + w.y * b->colour[3] + w.z * c->colour[3]);
  if (material->texture != CLPV_NO_TEXTURE) {
    alpha *= clpv_bilinear_alpha(textures + material->texture * CLPV_TEXTURE_LEVELS, texels,
                                 w.x * a->uv[0] + w.y * b->uv[0] + w.z * c->uv[0],
                                 w.x * a->uv[1] + w.y * b->uv[1] + w.z * c->uv[1]);
  }
  return alpha >= material->alpha_cutoff;
}

__kernel void draw_tiles(const ClpvView view, const uint fresh, __global const ClpvRasterTriangle* list,
                         __global const uint* ends, __global const uint* binned,
                         __global const ClpvVertex* vertices, __global const ClpvTriangle* triangles,
                         __global const ClpvMaterial* materials, __global const ClpvTexture* textures,
                         __global const uint* texels, __global float8* keys, __global uint8* seen) {
  const uint tiles_x = (view.width + CLPV_TILE - 1) / CLPV_TILE, x = get_global_id(0), y = get_global_id(1);
  if (x >= tiles_x || y * CLPV_TILE >= view.height) return;
  const uint tile = y * tiles_x + x;
  const int tile_x = (int)x * CLPV_TILE, tile_y = (int)y * CLPV_TILE;
  const float far_key = CLPV_ORTHOGRAPHIC ? view.far_depth : -1.0f / view.far_depth;
  __global float8* tile_keys = keys + tile * CLPV_TILE;
  __global uint8* tile_seen = seen + tile * CLPV_TILE;
  if (fresh) {
    for (int row = 0; row < CLPV_TILE; ++row) {
      tile_keys[row] = (float8)(INFINITY);
      tile_seen[row] = (uint8)(UINT_MAX);
    }
  }
  const float8 column = (float8)(0, 1, 2, 3, 4, 5, 6, 7);
  const long8 lane = (long8)(0, 1, 2, 3, 4, 5, 6, 7);
  const uint end = ends[tile];
  for (uint i = tile == 0 ? 0 : ends[tile - 1]; i < end; ++i) {
    const ClpvRasterTriangle r = list[binned[i]];
    const int first_x = (int)(r.first & 0xffffu), first_y = (int)(r.first >> 16);
    const int top = max(first_y - tile_y, 0), bottom = min((int)(r.last >> 16) - tile_y, CLPV_TILE - 1);
    const Edge e0 = edge_at(r, 0, 1, tile_x, tile_y + top);
    const Edge e1 = edge_at(r, 1, 2, tile_x, tile_y + top);
    const Edge e2 = edge_at(r, 2, 0, tile_x, tile_y + top);
    long8 v0 = e0.value + lane * e0.step_x, v1 = e1.value + lane * e1.step_x,
          v2 = e2.value + lane * e2.step_x;
    for (int row = top; row <= bottom; ++row) {
      const int8 inside = convert_int8((v0 | v1 | v2) >= 0L);
      v0 += e0.step_y;
      v1 += e1.step_y;
      v2 += e2.step_y;
      const float8 key = clamp(
          r.key + r.key_y * (float)(tile_y + row - first_y) + r.key_x * (column + (float)(tile_x - first_x)),
          r.nearest, r.farthest);
      const float8 old = tile_keys[row];
      const uint8 old_seen = tile_seen[row];
      int8 closer = inside & (key <= far_key) & ((key < old) | ((key == old) & (r.triangle < old_seen)));
      if (!any(closer)) continue;
      if (r.masked) {
        int lanes[8];
        float lane_keys[8];
        vstore8(closer, 0, lanes);
        vstore8(key, 0, lane_keys);
        for (int k = 0; k < 8; ++k) {
          if (lanes[k] && !is_solid(view, r.triangle, tile_x + k, tile_y + row, lane_keys[k], vertices,
                                    triangles, materials, textures, texels)) {
            lanes[k] = 0;
          }
        }
        closer = vload8(0, lanes);
      }
      tile_keys[row] = select(old, key, closer);
      tile_seen[row] = select(old_seen, (uint8)(r.triangle), closer);
    }
  }
}
