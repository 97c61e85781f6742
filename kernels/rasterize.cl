// SPDX-License-Identifier: MIT
// From a scene's triangles to lists of those over each tile of a view.
//
//   project_vertices   every vertex onto the screen, snapped to 1/256 pixel
//   set_up             triangles that may cover a pixel's centre -> a list of ClpvRasterTriangle
//   set_up_clipped     the same for those that cross the near plane or the guard band
//   bin_triangles      counts, then lists, the triangles over each tile of 8 x 8 pixels
// and draw_tiles.cl finds out which of them each pixel sees, resolve.cl what that looks like.
//
// Lists are in no particular order: atomics hand out their places.
#include "clip.h"
#include "edges.h"

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

static inline Face face_of(const ClpvView view, __global const ClpvVertex* vertices, const ClpvTriangle t) {
  return clpv_face(view, vec_load(vertices[t.vertex[0]].position), vec_load(vertices[t.vertex[1]].position),
                   vec_load(vertices[t.vertex[2]].position));
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
  const int least_x = min(a.x, min(b.x, c.x)), least_y = min(a.y, min(b.y, c.y));
  const int most_x = max(a.x, max(b.x, c.x)), most_y = max(a.y, max(b.y, c.y));
  const int left = max(first_centre(least_x), 0), right = min(last_centre(most_x), (int)view.width - 1);
  const int top = max(first_centre(least_y), 0), bottom = min(last_centre(most_y), (int)view.height - 1);
  if (left > right || top > bottom) return;
  const uint at = atomic_inc(count);
  if (at >= capacity) return;
  if (area < 0) {
    const ClpvProjected swapped = b;
    b = c;
    c = swapped;
  }
  ClpvRasterTriangle r;
  r.x[0] = a.x, r.x[1] = b.x, r.x[2] = c.x, r.x[3] = a.x;
  r.y[0] = a.y, r.y[1] = b.y, r.y[2] = c.y, r.y[3] = a.y;
  r.nearest = fmin(a.key, fmin(b.key, c.key));
  r.farthest = fmax(a.key, fmax(b.key, c.key));
  const Vec plane = clpv_key_plane(view, face, (float)left, (float)top);
  const bool edge_on = !isfinite(plane.x) || !isfinite(plane.y) || !isfinite(plane.z);
  r.key = edge_on ? r.nearest : plane.x;
  r.key_x = edge_on ? 0.0f : plane.y;
  r.key_y = edge_on ? 0.0f : plane.z;
  r.first = (uint)left + ((uint)top << 16);
  r.last = (uint)right + ((uint)bottom << 16);
  const bool small = most_x - least_x <= CLPV_SMALL_PIXELS * CLPV_SUBPIXELS &&
                     most_y - least_y <= CLPV_SMALL_PIXELS * CLPV_SUBPIXELS;
  r.triangle = triangle | (small ? CLPV_TRIANGLE_SMALL : 0) |
               (flags & CLPV_MATERIAL_MASKED ? CLPV_TRIANGLE_MASKED : 0);
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
  append(view, a, b, c, face_of(view, vertices, t), first + i, materials[t.material].flags, cull, counts,
         capacity, list);
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
  const Face face = face_of(view, vertices, t);
  const ClpvProjected apex = clpv_project(view, polygon[0]);
  for (int k = 2; k < corners; ++k) {
    append(view, apex, clpv_project(view, polygon[k - 1]), clpv_project(view, polygon[k]), face, triangle,
           materials[t.material].flags, cull, counts, capacity, list);
  }
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
  const Edge e0 = edge_at(list + i, 0, left * CLPV_TILE, top * CLPV_TILE);
  const Edge e1 = edge_at(list + i, 1, left * CLPV_TILE, top * CLPV_TILE);
  const Edge e2 = edge_at(list + i, 2, left * CLPV_TILE, top * CLPV_TILE);
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
