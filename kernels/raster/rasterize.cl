// SPDX-License-Identifier: MIT
// Sets up the triangles of a view for rasterisation: projects, culls and clips them, and lists the tiles that each may
// cover (docs/method.md, 'Rasterize').
//
//   set_up           triangles of the clusters in view
//   set_up_clipped   those that cross the near plane or the guard band, which set_up defers
//
// bin_tiles.cl then sorts the entries by tile, draw_tiles.cl finds the nearest triangle of each pixel, and resolve.cl
// evaluates its surface.
//
// In:      vertices, triangles, materials   the scene, in rows of float4: three per vertex, one per triangle
//          clusters  numbers of the clusters in view, `count` from `first` on; last: number of triangles of the scene
//          cull      1: drop back faces of one-sided materials
// Out:     list      ClpvRasterTriangle of those that may cover the centre of a pixel, in no particular order
//          entries   CLPV_ENTRY_WORDS words for each listed triangle and tile of 8 x 8 pixels that it may cover
//          to_clip   numbers of the triangles that set_up defers
// In, out: counts    CLPV_LISTED and so on. They count beyond the capacities most_listed and most_entered as well: the
//                    host then enlarges the lists and starts again, or draw_tiles draws without entries.
//          slice_counts   number of entries of each slice of each tile
// A work-item of set_up takes W triangles.
#include "raster/clip.h"
#include "raster/enter_tiles.h"
#include "shared/region.h"

// W triangles of the scene, projected to the screen.
typedef struct {
  ScreenCorner a, b, c;
  Face face;
  uintW triangle;  // index in the scene
  uintW flags;     // of the material
} ScreenTriangles;

// Box of pixels whose centres lie between the corners of a triangle.
typedef struct {
  intW left, right, top, bottom;
  intW small, giant;  // masks: no side above CLPV_SMALL_PIXELS; a side above CLPV_GIANT_PIXELS
} Box;

static inline intW smallest(const intW a, const intW b, const intW c) { return min(a, min(b, c)); }
static inline intW largest(const intW a, const intW b, const intW c) { return max(a, max(b, c)); }

// First pixel whose centre is at or after a sub-pixel coordinate, and last pixel whose centre is at or before it.
static inline intW first_centre(const intW at) { return (at + CLPV_SUBPIXELS / 2 - 1) >> 8; }
static inline intW last_centre(const intW at) { return (at - CLPV_SUBPIXELS / 2) >> 8; }

static inline Box box_of(const ClpvView view, const ScreenTriangles t) {
  const intW min_x = smallest(t.a.x, t.b.x, t.c.x), min_y = smallest(t.a.y, t.b.y, t.c.y);
  const intW max_x = largest(t.a.x, t.b.x, t.c.x), max_y = largest(t.a.y, t.b.y, t.c.y);
  Box box;
  box.left = max(first_centre(min_x), (intW)(0));
  box.right = min(last_centre(max_x), (intW)((int)view.width - 1));
  box.top = max(first_centre(min_y), (intW)(0));
  box.bottom = min(last_centre(max_y), (intW)((int)view.height - 1));
  const intW longest = max(max_x - min_x, max_y - min_y);
  box.small = longest <= CLPV_SMALL_PIXELS * CLPV_SUBPIXELS;
  box.giant = longest > CLPV_GIANT_PIXELS * CLPV_SUBPIXELS;
  return box;
}

// Sign of the area on the screen; positive is clockwise, with y downwards.
static inline intW winding(const ScreenTriangles t) {
  const longW area = to_longW(t.b.x - t.a.x) * to_longW(t.c.y - t.a.y) -
                     to_longW(t.c.x - t.a.x) * to_longW(t.b.y - t.a.y);
  const intW clockwise = to_intW(area > 0L), other = to_intW(area < 0L);
  return clockwise ? (intW)(1) : (other ? (intW)(-1) : (intW)(0));
}

// Edge function at the upper left pixel of a box of at most 2 x 2 pixels, and its change across the box. 0 in lanes
// outside `tiny`, whose coordinates may not fit 32 bits.
typedef struct {
  intW value, step_x, step_y;
} TinyEdge;

static inline TinyEdge tiny_edge(const ScreenCorner p, const ScreenCorner q, const Box box, const intW tiny) {
  const intW dx = (q.x - p.x) & tiny, dy = (q.y - p.y) & tiny;
  const intW to_x = (box.left * CLPV_SUBPIXELS + CLPV_SUBPIXELS / 2 - p.x) & tiny;
  const intW to_y = (box.top * CLPV_SUBPIXELS + CLPV_SUBPIXELS / 2 - p.y) & tiny;
  const intW top_left = all_bits((dy < 0) | ((dy == 0) & (dx > 0)));
  TinyEdge edge;
  edge.value = dx * to_y - dy * to_x - 1 - top_left;
  edge.step_x = -dy * ((box.right - box.left) * CLPV_SUBPIXELS & tiny);
  edge.step_y = dx * ((box.bottom - box.top) * CLPV_SUBPIXELS & tiny);
  return edge;
}

// Mask of the triangles with a box of at most 2 x 2 pixels that cover none of its centres. Exact; about 33 % of them
// miss.
static inline intW misses(const ScreenTriangles t, const Box box) {
  const intW tiny = all_bits(box.small & (box.right - box.left <= 1) & (box.bottom - box.top <= 1));
  const TinyEdge e0 = tiny_edge(t.a, t.b, box, tiny), e1 = tiny_edge(t.b, t.c, box, tiny),
                 e2 = tiny_edge(t.c, t.a, box, tiny);
  const intW right0 = e0.value + e0.step_x, right1 = e1.value + e1.step_x, right2 = e2.value + e2.step_x;
  const intW out = (e0.value | e1.value | e2.value) & (right0 | right1 | right2) &
                   (e0.value + e0.step_y | e1.value + e1.step_y | e2.value + e2.step_y) &
                   (right0 + e0.step_y | right1 + e1.step_y | right2 + e2.step_y);
  return tiny & (out < 0);
}

// Converts to the words of ClpvRasterTriangle.
CLPV_INLINE void write_words(const ClpvView view, const ScreenTriangles t, const Box box, RasterWords* words) {
  const realW nearest = fmin(t.a.key, fmin(t.b.key, t.c.key)), farthest = fmax(t.a.key, fmax(t.b.key, t.c.key));
  const Vec plane = find_key_plane(view, t.face, to_realW(box.left), to_realW(box.top));
  const intW edge_on = (isfinite(plane.x) & isfinite(plane.y) & isfinite(plane.z)) == 0;
  const uintW kinds = (box.giant ? (uintW)(CLPV_TRIANGLE_GIANT) : (uintW)(0u)) |
                      ((t.flags & CLPV_MATERIAL_MASKED) != 0u ? (uintW)(CLPV_TRIANGLE_MASKED) : (uintW)(0u));
  store_lanes(t.a.x, words->word[0]);
  store_lanes(t.b.x, words->word[1]);
  store_lanes(t.c.x, words->word[2]);
  store_lanes(t.a.x, words->word[3]);
  store_lanes(t.a.y, words->word[4]);
  store_lanes(t.b.y, words->word[5]);
  store_lanes(t.c.y, words->word[6]);
  store_lanes(t.a.y, words->word[7]);
  store_lanes(as_intW(edge_on ? nearest : plane.x), words->word[8]);
  store_lanes(as_intW(edge_on ? ZERO : plane.y), words->word[9]);
  store_lanes(as_intW(edge_on ? ZERO : plane.z), words->word[10]);
  store_lanes(as_intW(nearest), words->word[11]);
  store_lanes(as_intW(farthest), words->word[12]);
  store_lanes(box.left + (box.top << 16), words->word[13]);
  store_lanes(box.right + (box.bottom << 16), words->word[14]);
  store_lanes(as_intW(t.triangle | kinds), words->word[15]);
}

// Appends the triangles of the lanes in `mask`, except those that cover no pixel's centre and culled back faces.
CLPV_INLINE void append(const ClpvView view, ScreenTriangles t, intW mask, const uint cull, volatile __global uint* counts,
                        const Capacity capacity, __global ClpvRasterTriangle* list, __global uint* entries,
                        volatile __global uint* slice_counts) {
  const intW wound = winding(t);
  const intW one_sided = (t.flags & CLPV_MATERIAL_DOUBLE_SIDED) == 0u;
  mask &= (wound < 0) | ((wound > 0) & ((cull ? 0 : -1) | (one_sided == 0)));
  const Box box = box_of(view, t);
  mask &= (box.left <= box.right) & (box.top <= box.bottom);
  if (no_lane(mask)) return;
  const ScreenCorner b = t.b, c = t.c;
  t.b.x = wound < 0 ? c.x : b.x, t.b.y = wound < 0 ? c.y : b.y;
  t.c.x = wound < 0 ? b.x : c.x, t.c.y = wound < 0 ? b.y : c.y;
  mask &= misses(t, box) == 0;
  if (no_lane(mask)) return;
  RasterWords words;
  write_words(view, t, box, &words);
  list_lanes(view, &words, mask, counts, capacity, list, entries, slice_counts);
}

CLPV_INLINE void load_position(__global const float4* vertices, const uintW vertex, Vec* position) {
  Rows rows;
  gather_rows(vertices, 3u * vertex, &rows);
  *position = vec(CLPV_COLUMN(rows, x), CLPV_COLUMN(rows, y), CLPV_COLUMN(rows, z));
}

// Defers the triangles of some lanes to set_up_clipped.
static inline void defer(const intW lanes, const uintW triangle, volatile __global uint* counts,
                         __global uint* to_clip) {
  int deferred[W];
  uint index[W];
  store_lanes(lanes, deferred);
  store_lanes(triangle, index);
  for (int lane = 0; lane < W; ++lane) {
    if (deferred[lane]) to_clip[atomic_inc(counts + CLPV_TO_CLIP)] = index[lane];
  }
}

__kernel void set_up(const ClpvView view, __global const uint* clusters, const uint first, const uint count,
                     const uint last, const uint cull, __global const float4* vertices,
                     __global const float4* triangles, __global const ClpvMaterial* materials,
                     volatile __global uint* counts, const uint most_listed,
                     __global ClpvRasterTriangle* list, const uint most_entered, __global uint* entries,
                     volatile __global uint* slice_counts, __global uint* to_clip) {
  const uint item = get_global_id(0), cluster = item / (CLPV_CLUSTER / W);
  if (cluster >= count) return;
  const uintW lane = as_uintW(lane_numbers());
  const uintW number =
      clusters[first + cluster] * CLPV_CLUSTER + item % (CLPV_CLUSTER / W) * W + lane;
  const uintW triangle = min(number, (uintW)(last - 1));
  Rows rows;
  gather_rows(triangles, triangle, &rows);
  Vec a, b, c;
  load_position(vertices, as_uintW(CLPV_COLUMN(rows, x)), &a);
  load_position(vertices, as_uintW(CLPV_COLUMN(rows, y)), &b);
  load_position(vertices, as_uintW(CLPV_COLUMN(rows, z)), &c);
  const ViewPoint p = view_point(view, a), q = view_point(view, b), r = view_point(view, c);
  const intW p_is = where_is(view, p), q_is = where_is(view, q), r_is = where_is(view, r);
  const intW visible = (number < last) & ((p_is & q_is & r_is & CLPV_OUT_OF_SIGHT) == 0);
  if (no_lane(visible)) return;
  const intW clipped = visible & (((p_is | q_is | r_is) & CLPV_NEEDS_CLIPPING) != 0);
  if (!no_lane(clipped)) defer(clipped, triangle, counts, to_clip);
  const uintW material = as_uintW(CLPV_COLUMN(rows, w));
  const uintW flags = (uintW)CLPV_GATHER_MEMBER(materials, material, .flags);
  const ScreenTriangles t = {project(view, p), project(view, q), project(view, r), make_face(view, a, b, c),
                             triangle,         flags};
  const Capacity capacity = {most_listed, most_entered};
  append(view, t, visible & (clipped == 0), cull, counts, capacity, list, entries, slice_counts);
}

#if W > 1

// Corners of a clipped triangle, padded so that W lanes can be loaded from any of them.
typedef struct {
  int x[CLPV_CLIP_CORNERS + W], y[CLPV_CLIP_CORNERS + W];
  float key[CLPV_CLIP_CORNERS + W];
} Outline;

static inline void project_polygon(const ClpvView view, const float4* polygon, const int corners, Outline* outline) {
  for (int k = 0; k < CLPV_CLIP_CORNERS + W; ++k) {
    const float4 at = polygon[k < corners ? k : 0];
    const ViewPoint point = {(realW)(at.x), (realW)(at.y), (realW)(at.w), (realW)(at.z)};
    const ScreenCorner corner = project(view, point);
    outline->x[k] = first_lane(corner.x);
    outline->y[k] = first_lane(corner.y);
    outline->key[k] = first_lane(corner.key);
  }
}

static inline ScreenCorner load_outline(const Outline* outline, const int k) {
  const ScreenCorner corner = {load_lanes(outline->x + k), load_lanes(outline->y + k), load_lanes(outline->key + k)};
  return corner;
}

static inline ScreenCorner load_outline_apex(const Outline* outline) {
  const ScreenCorner corner = {(intW)(outline->x[0]), (intW)(outline->y[0]), (realW)(outline->key[0])};
  return corner;
}

#else

CLPV_INLINE ScreenCorner project_corner(const ClpvView view, CLPV_POLYGON const float4* polygon, const int k) {
  const float4 at = polygon[CLPV_CORNER(k)];
  const ViewPoint point = {at.x, at.y, at.w, at.z};
  return project(view, point);
}

#endif

// Clips the deferred triangles. The clipped polygon becomes a fan about its first corner.
#if W == 1
__attribute__((reqd_work_group_size(CLPV_CLIP_GROUP, 1, 1)))
#endif
__kernel void set_up_clipped(const ClpvView view, const uint cull, __global const float4* vertices,
                             __global const float4* triangles, __global const ClpvMaterial* materials,
                             volatile __global uint* counts, const uint most_listed, __global ClpvRasterTriangle* list,
                             const uint most_entered, __global uint* entries, volatile __global uint* slice_counts,
                             __global uint* to_clip) {
#if W == 1
  __local float4 polygons[CLPV_CLIP_CORNERS * CLPV_CLIP_GROUP];
  __local float4* polygon = polygons + get_local_id(0);
#else
  float4 polygon[CLPV_CLIP_CORNERS];
#endif
  const Capacity capacity = {most_listed, most_entered};
  const intW lane = lane_numbers();
  for (uint i = get_global_id(0); i < counts[CLPV_TO_CLIP]; i += get_global_size(0)) {
    const uint triangle = to_clip[i];
    const uint4 t = as_uint4(triangles[triangle]);
    Vec a, b, c;
    load_position(vertices, (uintW)(t.x), &a);
    load_position(vertices, (uintW)(t.y), &b);
    load_position(vertices, (uintW)(t.z), &c);
    polygon[CLPV_CORNER(0)] = polygon_corner(view_point(view, a));
    polygon[CLPV_CORNER(1)] = polygon_corner(view_point(view, b));
    polygon[CLPV_CORNER(2)] = polygon_corner(view_point(view, c));
    const int corners = clip_polygon(view, polygon);
    if (corners == 0) continue;
#if W > 1
    Outline outline;
    project_polygon(view, polygon, corners, &outline);
#define CLPV_FAN(k) load_outline_apex(&outline), load_outline(&outline, k), load_outline(&outline, k + 1)
#else
#define CLPV_FAN(k) project_corner(view, polygon, 0), project_corner(view, polygon, k), project_corner(view, polygon, k + 1)
#endif
    for (int k = 1; k + 1 < corners; k += W) {
      const ScreenTriangles fan = {CLPV_FAN(k), make_face(view, a, b, c), (uintW)(triangle),
                                   (uintW)(materials[t.w].flags)};
      append(view, fan, k + 1 + lane < corners, cull, counts, capacity, list, entries, slice_counts);
    }
  }
}
