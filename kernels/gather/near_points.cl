// SPDX-License-Identifier: MIT
// Points of the near field's pixels (near_layout.h).
//
// near_points
//   Writes layer 1: the first pixel of each block of CLPV_PLANE_STEP x CLPV_PLANE_STEP. Clears all
//   other points.
// near_others
//   Writes layer 2: in each block, the first pixel whose surface has no layer-1 pixel in the 4 x 4
//   blocks around.
//
// In:   places, normals   the camera's surface (surface_row.h): depths [m], or with CLPV_POINTS
//                         positions [m]
//       grids             ClpvGrid of each cascade
// Out:  points                planes of shared/near.h, with their border
// A work-item processes W near pixels of a row.
#include "gather/near_surface.h"
#include "gather/radiance.h"
#include "raster/surface_row.h"

// Cell of the cascades at W positions [m], blended like their light; 0 outside the mask `wanted`.
CLPV_INLINE realW find_reach(__global const ClpvGrid* grids, const uint cascades,
                             const Vec position, const intW wanted) {
  realW reach = ZERO, remaining = wanted ? ONE : ZERO;
  for (uint c = 0; c < cascades; ++c) {
    const ClpvGrid grid = grids[c];
    const realW share = cascade_share(grid, position);
    reach += share * remaining * grid.cell;
    remaining *= 1.0f - share;
  }
  return reach;
}

// Surfaces of W pixels of the camera.
typedef struct {
  intW seen;
  Vec position, normal;
  realW geometric;  // number of the geometric normal (shared/normal.h)
} CameraPixels;

// Loads the surfaces of pixels (x, y); lanes outside the mask `inside` get none.
CLPV_INLINE void load_camera_pixels(const ClpvView view, __global const Place* places,
                                    __global const float4* normals, const intW x, const int y,
                                    const intW inside, CameraPixels* c) {
  const uintW pixel = inside ? as_uintW(y * (int)view.width + x) : (uintW)(0u);
  Rows rows;
#if CLPV_POINTS
  gather_rows(places, pixel, &rows);
  const realW depth = CLPV_COLUMN(rows, w);
  const Vec position = vec(CLPV_COLUMN(rows, x), CLPV_COLUMN(rows, y), CLPV_COLUMN(rows, z));
#else
  PixelRow p;
  p.x = to_realW(x);
  p.y = (realW)((float)y);
  const realW depth = (realW)CLPV_GATHER(places, pixel);
  const Vec position = row_positions(view, p, depth);
#endif
  gather_rows(normals, pixel, &rows);
  c->seen = inside & (depth > ZERO);
  c->position = vec_masked(c->seen, position);
  c->normal =
      vec_masked(c->seen, vec(CLPV_COLUMN(rows, x), CLPV_COLUMN(rows, y), CLPV_COLUMN(rows, z)));
  c->geometric = c->seen ? CLPV_COLUMN(rows, w) : ZERO;
}

CLPV_INLINE void store_points(const PlaneRow r, const CameraPixels c, const realW reach,
                              __global float* points) {
  store_plane_vectors(c.position, points + CLPV_NEAR_POSITION * r.plane, r.plane, r.at);
  store_plane_vectors(c.normal, points + CLPV_NEAR_NORMAL * r.plane, r.plane, r.at);
  store_lanes(reach, points + CLPV_NEAR_REACH * r.plane + r.at);
  store_lanes(c.geometric, points + CLPV_NEAR_GEOMETRIC * r.plane + r.at);
}

__kernel void near_points(const ClpvView view, __global const Place* places,
                          __global const float4* normals, __global const ClpvGrid* grids,
                          const uint cascades, __global float* points) {
  const PlaneRow r = find_plane_row(view, (int)get_global_id(0) - CLPV_PLANE_COLUMNS / W,
                                  (int)get_global_id(1) - CLPV_PLANE_ROWS);
  if ((uint)(r.x + CLPV_PLANE_COLUMNS) >= r.pitch || r.y >= (int)r.height + CLPV_PLANE_ROWS) return;
  const intW x = r.x + lane_numbers();
  const intW inside =
      (x >= 0) & (x < (int)r.width) & (r.y >= 0 && r.y < (int)plane_pixels(view.height) ? -1 : 0);
  CameraPixels c;
  load_camera_pixels(view, places, normals, x * CLPV_PLANE_STEP, r.y * CLPV_PLANE_STEP, inside, &c);
  store_points(r, c, find_reach(grids, cascades, c.position, c.seen), points);
}

#if CLPV_PLANE_LAYERS > 1
// Mask of the surfaces that none of the near pixels in columns and rows `from` to `to` has.
CLPV_INLINE intW on_no_surface(__global const float* points, const PlaneRow r, const int from,
                               const int to, const CameraPixels c, intW wanted) {
  for (int dy = from; dy <= to; ++dy) {
    for (int dx = from; dx <= to; ++dx) {
      NearSurfaces n;
      load_near_surfaces(points, r.plane, (uint)((int)r.at + dy * (int)r.pitch + dx), &n);
      wanted &= same_surface(n, c.position, c.normal) == 0;
    }
  }
  return wanted;
}

__kernel void near_others(const ClpvView view, __global const Place* places,
                          __global const float4* normals, __global const ClpvGrid* grids,
                          const uint cascades, __global float* points) {
  const PlaneRow first = find_plane_row(view, get_global_id(0), get_global_id(1));
  if (!row_has_pixels(first) || first.y >= (int)plane_pixels(view.height)) return;
  const intW x = (first.x + lane_numbers()) * CLPV_PLANE_STEP;
  CameraPixels found = {(intW)(0), {ZERO, ZERO, ZERO}, {ZERO, ZERO, ZERO}, ZERO};
  for (int dy = 0; dy < CLPV_PLANE_STEP && first.y * CLPV_PLANE_STEP + dy < (int)view.height;
       ++dy) {
    for (int dx = 0; dx < CLPV_PLANE_STEP; ++dx) {
      CameraPixels c;
      load_camera_pixels(view, places, normals, x + dx, first.y * CLPV_PLANE_STEP + dy,
                         x + dx < (int)view.width, &c);
      intW wanted = on_no_surface(points, first, 0, 1, c, c.seen & (found.seen == 0));
      if (lane_bits(wanted) == 0u) continue;
      wanted = on_no_surface(points, first, -1, 2, c, wanted);
      if (lane_bits(wanted) == 0u) continue;
      found.seen |= wanted;
      found.position = vec_selected(wanted, c.position, found.position);
      found.normal = vec_selected(wanted, c.normal, found.normal);
      found.geometric = wanted ? c.geometric : found.geometric;
    }
  }
  const PlaneRow second =
      find_plane_row(view, get_global_id(0), (int)(get_global_id(1) + second_layer_row(view)));
  store_points(second, found, find_reach(grids, cascades, found.position, found.seen), points);
}
#endif
