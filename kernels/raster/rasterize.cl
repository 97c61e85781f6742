// SPDX-License-Identifier: MIT
// Sets up the triangles of a view for rasterisation: projects, culls and clips them, and lists the
// tiles that each may cover (docs/method.md, 'Rasterize').
//
//   set_up           triangles of the clusters in all views that are drawn together
//   set_up_clipped   those that cross the near plane or the guard band, which set_up defers
//   enter_wide       tile entries of wide triangles, left over by both kernels above: one work-item
//                    would take too long
//
// bin_tiles.cl then sorts the entries by tile, draw_tiles.cl finds the nearest triangle of each
// pixel, and resolve.cl evaluates its surface.
//
// In:      views     of one size
//          vertices, triangles, materials   the scene, in rows of float4: three per vertex, one per
//                                           triangle
//          clusters  the clusters in the views, `count` from `first` on
//          last      number of triangles of the scene
//          cull      1: drop back faces of one-sided materials
// Out:     list      ClpvRasterTriangle of those that may cover the centre of a pixel, in no
//                    particular order
//          entries   CLPV_ENTRY_WORDS words for each tile of a listed triangle's box; CLPV_NO_SLICE
//                    where it misses the tile
//          to_clip   triangles that set_up defers: CLPV_CLUSTER times the index in `clusters`, plus
//                    the number in the cluster
//          wide      those whose entries are deferred
// In, out: counts    CLPV_LISTED and so on. They count beyond the capacities most_listed and
//                    most_entered as well: the host then enlarges the lists and starts again, or
//                    draw_tiles draws without entries.
//          slice_counts   number of entries of each slice of each tile
// A work-item of set_up takes W triangles.
#include "raster/clip.h"
#include "raster/screen_triangles.h"
#include "shared/region.h"

// Positions [m] of the vertices of W triangles, whose numbers are a, b and c.
typedef struct {
  Vec a, b, c;
} Positions;

CLPV_INLINE Vec load_position(__global const float4* vertices, const uintW vertex) {
  Rows rows;
  gather_rows(vertices, 3u * vertex, &rows);
  return vec(CLPV_COLUMN(rows, x), CLPV_COLUMN(rows, y), CLPV_COLUMN(rows, z));
}

CLPV_INLINE Positions load_positions(__global const float4* vertices, const uintW a, const uintW b,
                                     const uintW c) {
  const Positions p = {load_position(vertices, a), load_position(vertices, b),
                       load_position(vertices, c)};
  return p;
}

// Defers the triangles of some lanes to set_up_clipped.
static inline void defer(const intW lanes, const uint first, volatile __global uint* counts,
                         __global uint* to_clip) {
  int deferred[W];
  store_lanes(lanes, deferred);
  for (int lane = 0; lane < W; ++lane) {
    if (deferred[lane]) to_clip[atomic_inc(counts + CLPV_TO_CLIP)] = first + lane;
  }
}

#if W == 1
__attribute__((reqd_work_group_size(CLPV_CLUSTER, 1, 1)))
#endif
__kernel void set_up(__constant const ClpvView* views, __global const ClpvViewCluster* clusters,
                     const uint first, const uint count, const uint last, const uint cull,
                     __global const float4* vertices, __global const float4* triangles,
                     __global const ClpvMaterial* materials, volatile __global uint* counts,
                     const uint most_listed, __global ClpvRasterTriangle* list,
                     const uint most_entered, __global uint* entries,
                     volatile __global uint* slice_counts, __global ClpvWideTriangle* wide,
                     __global uint* to_clip) {
  const uint item = get_global_id(0),
             cluster = W == 1 ? get_group_id(0) : item / (CLPV_CLUSTER / W),
             in_cluster = item % (CLPV_CLUSTER / W) * W;
  if (cluster >= count) return;
  const ClpvViewCluster in_view = clusters[first + cluster];
  if (in_view.number == CLPV_HIDDEN) return;
  const ClpvView view = views[in_view.view];
  const uintW number = in_view.number * CLPV_CLUSTER + in_cluster + as_uintW(lane_numbers());
  const uintW triangle = min(number, (uintW)(last - 1));
  Rows rows;
  gather_rows(triangles, triangle, &rows);
  const Positions at =
      load_positions(vertices, as_uintW(CLPV_COLUMN(rows, x)), as_uintW(CLPV_COLUMN(rows, y)),
                     as_uintW(CLPV_COLUMN(rows, z)));
  const ViewPoint p = view_point(view, at.a), q = view_point(view, at.b),
                  r = view_point(view, at.c);
  const intW p_is = outcodes_of(view, p), q_is = outcodes_of(view, q), r_is = outcodes_of(view, r);
  const intW visible = (number < last) & ((p_is & q_is & r_is & CLPV_OUT_OF_SIGHT) == 0);
  if (W > 1 && no_lane(visible)) return;
  const intW clipped = visible & (((p_is | q_is | r_is) & CLPV_NEEDS_CLIPPING) != 0);
  if (!no_lane(clipped))
    defer(clipped, (first + cluster) * CLPV_CLUSTER + in_cluster, counts, to_clip);
  const uintW material = as_uintW(CLPV_COLUMN(rows, w));
  const uintW flags = (uintW)CLPV_GATHER_MEMBER(materials, material, .flags);
  const ScreenTriangles t = {project(view, p), project(view, q),
                             project(view, r), make_face(view, at.a, at.b, at.c),
                             triangle,         flags};
  const Capacity capacity = {most_listed, most_entered};
  const Entries to = {entries, slice_counts, wide, in_view.view};
#if W == 1
  __local uint sums[2], base[2];
  RasterWords words;
  const int listed = visible && !clipped && find_words(view, t, 1, cull, &words);
  Places room = {0, 0};
  if (listed) room = needed(&words, 1);
  const Places first_place = reserve_by_group(counts, room, sums, base);
  if (listed) list_lanes(view, &words, 1, room, first_place, counts, capacity, list, to);
#else
  append(view, t, visible & (clipped == 0), cull, counts, capacity, list, to);
#endif
}

// Clips the deferred triangles. The clipped polygon becomes a fan about its first corner.
#if W == 1
__attribute__((reqd_work_group_size(CLPV_CLIP_GROUP, 1, 1)))
#endif
__kernel void set_up_clipped(__constant const ClpvView* views,
                             __global const ClpvViewCluster* clusters, const uint cull,
                             __global const float4* vertices, __global const float4* triangles,
                             __global const ClpvMaterial* materials, volatile __global uint* counts,
                             const uint most_listed, __global ClpvRasterTriangle* list,
                             const uint most_entered, __global uint* entries,
                             volatile __global uint* slice_counts,
                             __global ClpvWideTriangle* wide, __global uint* to_clip) {
#if W == 1
  __local float4 polygons[CLPV_CLIP_CORNERS * CLPV_CLIP_GROUP];
  __local float4* polygon = polygons + get_local_id(0);
#else
  float4 polygon[CLPV_CLIP_CORNERS];
#endif
  const Capacity capacity = {most_listed, most_entered};
  const intW lane = lane_numbers();
  for (uint i = get_global_id(0); i < counts[CLPV_TO_CLIP]; i += get_global_size(0)) {
    const ClpvViewCluster cluster = clusters[to_clip[i] / CLPV_CLUSTER];
    const uint triangle = cluster.number * CLPV_CLUSTER + to_clip[i] % CLPV_CLUSTER;
    const ClpvView view = views[cluster.view];
    const Entries to = {entries, slice_counts, wide, cluster.view};
    const uint4 t = as_uint4(triangles[triangle]);
    const Positions at = load_positions(vertices, (uintW)(t.x), (uintW)(t.y), (uintW)(t.z));
    polygon[0] = polygon_corner(view_point(view, at.a));
    polygon[CLPV_CORNER] = polygon_corner(view_point(view, at.b));
    polygon[2 * CLPV_CORNER] = polygon_corner(view_point(view, at.c));
    const int corners = clip_polygon(view, polygon);
    if (corners == 0) continue;
    Outline outline;
    project_polygon(view, polygon, corners, &outline);
    const Face face = make_face(view, at.a, at.b, at.c);
    for (int k = 1; k + 1 < corners; k += W) {
      const ScreenTriangles fan = {outline_apex(view, &outline), outline_corners(view, &outline, k),
                                   outline_corners(view, &outline, k + 1), face, (uintW)(triangle),
                                   (uintW)(materials[t.w].flags)};
      append(view, fan, k + 1 + lane < corners, cull, counts, capacity, list, to);
    }
  }
}

// A work-group enters one triangle after the other. Returns at once if a list overflowed.
__kernel void enter_wide(__constant const ClpvView* views, __global const uint* counts,
                         const uint most_listed, const uint most_entered,
                         __global const ClpvRasterTriangle* list,
                         __global const ClpvWideTriangle* wide, __global uint* entries,
                         volatile __global uint* slice_counts) {
  if (counts[CLPV_ENTERED] > most_entered || counts[CLPV_ENTERED_TOO_MANY] > 0) return;
  if (counts[CLPV_LISTED] > most_listed) return;
  for (uint i = get_group_id(0); i < counts[CLPV_WIDE]; i += get_num_groups(0)) {
    const uint index = wide[i].index;
    const ClpvView view = views[wide[i].view];
    const uint tiles_x = tiles_across(view), first = wide[i].view * tiles_in(view);
    __global const ClpvRasterTriangle* r = list + index;
    const TileRange tiles = tiles_between(r->first, r->last);
    const uint slice = slice_of(view, r->triangle, r->nearest),
               columns = tiles.right - tiles.left + 1;
    for (uint k = get_local_id(0); k < tile_count(tiles); k += get_local_size(0)) {
      const int x = tiles.left + k % columns, y = tiles.top + k / columns;
      const int px = x * CLPV_TILE, py = y * CLPV_TILE;
      __global uint* entry = entries + CLPV_ENTRY_WORDS * (wide[i].entry + k);
      if ((largest_in_tile(edge_at(r, 0, px, py)) | largest_in_tile(edge_at(r, 1, px, py)) |
           largest_in_tile(edge_at(r, 2, px, py))) >= 0) {
        add_entry(entry, (first + y * tiles_x + x) * CLPV_SLICES + slice, index,
                  as_uint(r->nearest), slice_counts);
      } else {
        entry[0] = CLPV_NO_SLICE;
      }
    }
  }
}
