// SPDX-License-Identifier: MIT
// Near field: rays find light from surfaces nearer than R, which replaces the volumes' (docs/method.md, 'Near field').
//
//   D = (pi / K) sum_k (X(w_k) - v(w_k))     [W/m^2], w_k cosine-distributed about the normal n
//   X(w) = L_hit if a surface is met along w within R, else L(p + offset s n + R w, -w)
//   v(w) = L(p + offset s n, -w)
//   E    = max(0, E_gathered + mean of D over a tile)      (near_filter.cl)
//
// R and s: edge of a cell of the cascades at p, blended like their light. near_trace.cl finds hits, near_light.cl their
// radiance; radiance.h has L.
//
// near_points
//   In:   depths [m], normals   the camera's surface (surface.h); grids: ClpvGrid of each cascade
//   Out:  points                planes of shared/near.h, with their border
// near
//   In:   points, directions    near_layout.h
//         distances             per ray: distance of the hit [m], INFINITY without one
//         radiances             L_hit [W/m^2/sr] per ray: three planes for each k
//         CLPV_RADIANCE         volumes
//   Out:  differences           D, three planes
// A work-item processes eight pixels of a row.
#include "gather/near_layout.h"
#include "gather/radiance.h"
#include "raster/surface_row.h"

#define CLPV_LEAST_ARRIVING 0.5f  // minimum ratio of arriving to leaving irradiance at which misses get full weight

// Weight in [0, 1] of the correction for rays that miss. Nine harmonics of light that leaves a bright surface are
// not 0 towards it: where more leaves than arrives, the correction would be the difference of two such errors.
// (x, y, z) = n.
CLPV_INLINE float miss_weight(const Sampled* field, const float x, const float y, const float z) {
  const float4 arriving = field_irradiance(field, x, y, z), leaving = field_irradiance(field, -x, -y, -z);
  const float in = arriving.x + arriving.y + arriving.z, out = leaving.x + leaving.y + leaving.z;
  return in >= CLPV_LEAST_ARRIVING * out ? 1.0f : in / (CLPV_LEAST_ARRIVING * out);
}

__kernel void near_points(const ClpvView view, __global const float* depths, __global const float4* normals,
                          __global const ClpvGrid* grids, const uint cascades, __global float* points) {
  const NearRow r = find_near_row(view, (int)get_global_id(0) - CLPV_NEAR_COLUMNS / W,
                                  (int)get_global_id(1) - CLPV_NEAR_ROWS);
  if ((uint)(r.x + CLPV_NEAR_COLUMNS) >= r.pitch || r.y >= (int)r.height + CLPV_NEAR_ROWS) return;
  const intW x = r.x + lane_numbers();
  const intW inside = (x >= 0) & (x < (int)r.width) & (r.y >= 0 && r.y < (int)r.height ? -1 : 0);
  const uintW pixel = inside ? as_uintW(r.y * (int)view.width + x) * (uint)CLPV_NEAR_STEP : (uintW)(0u);
  PixelRow p;
  p.x = to_realW(x * CLPV_NEAR_STEP);
  p.y = (realW)((float)(r.y * CLPV_NEAR_STEP));
  Rows rows;
  gather_rows(normals, pixel, &rows);
  const realW depth = (realW)CLPV_GATHER(depths, pixel);
  const intW surface = inside & (depth > ZERO);
  const Vec position = vec_masked(surface, row_positions(view, p, depth));
  realW reach = ZERO, remaining = surface ? ONE : ZERO;
  for (uint c = 0; c < cascades; ++c) {
    const ClpvGrid grid = grids[c];
    const realW share = cascade_share(grid, position);
    reach += share * remaining * grid.cell;
    remaining *= 1.0f - share;
  }
  const Vec normal = vec(CLPV_COLUMN(rows, x), CLPV_COLUMN(rows, y), CLPV_COLUMN(rows, z));
  store_near_vectors(position, points + CLPV_NEAR_POSITION * r.plane, r.plane, r.at);
  store_near_vectors(vec_masked(surface, normal), points + CLPV_NEAR_NORMAL * r.plane, r.plane, r.at);
  store_lanes(reach, points + CLPV_NEAR_REACH * r.plane + r.at);
}

__kernel void near(const ClpvView view, __global const float* points, __global const realW* directions,
                   __global const float* distances, __global const float* radiances, __global float* differences,
                   CLPV_RADIANCE) {
  const NearRow r = find_near_row(view, get_global_id(0), get_global_id(1));
  if (!row_has_pixels(r)) return;
  NearPoints p;
  load_near_points(points, r, &p);
  const intW lit = p.reach > ZERO;
  RadianceField here, there;
  sample_radiance(CLPV_PASS_RADIANCE, p.position, (realW)(CLPV_GATHER_OFFSET), p.normal, lit, &here);
  const VecLanes n = unpack(lit, p.normal);
  float trusts[W];
  for (int i = 0; i < W; ++i) trusts[i] = miss_weight(&here.at[i], n.x[i], n.y[i], n.z[i]);
  const realW trust = load_lanes(trusts);
  const Vec lifted = vec_add_scaled(p.position, (realW)(CLPV_GATHER_OFFSET) * p.reach, p.normal);
  Vec sum = vec(ZERO, ZERO, ZERO);
  float4 volumes[W];
  for (int i = 0; i < W; ++i) volumes[i] = 0.0f;
  for (uint k = 0; k < CLPV_NEAR_RAYS; ++k) {
    const Vec w = find_near_directions(directions, r, &p, k);
    const intW hit = load_lanes(distances + k * r.plane + r.at) < (realW)(INFINITY);
    const intW missed = lit & ~hit & (trust > ZERO);
    sample_radiance(CLPV_PASS_RADIANCE, vec_add_scaled(lifted, p.reach, w), ZERO, p.normal, missed, &there);
    const VecLanes back = unpack(lit, vec_times(w, (realW)(-1.0f)));
    float shares[W];
    store_lanes(hit ? ONE : trust, shares);
    for (int i = 0; i < W; ++i) {
      if (!(shares[i] > 0.0f)) continue;
      Sampled change = there.at[i];
#define CLPV_DO(j, even, odd) change.p##j -= here.at[i].p##j;
      CLPV_EACH_PAIR(CLPV_DO)
#undef CLPV_DO
      volumes[i] += shares[i] * radiance_along(&change, back.x[i], back.y[i], back.z[i]);
    }
    const Vec met = load_near_vectors(radiances + 3 * k * r.plane, r.plane, r.at);
    sum = vec_add_scaled(sum, ONE, vec_masked(hit & lit, met));
  }
  float x[W], y[W], z[W];
  for (int i = 0; i < W; ++i) x[i] = volumes[i].x, y[i] = volumes[i].y, z[i] = volumes[i].z;
  sum = vec(sum.x + load_lanes(x), sum.y + load_lanes(y), sum.z + load_lanes(z));
  store_near_vectors(vec_times(sum, (realW)(M_PI_F / CLPV_NEAR_RAYS)), differences, r.plane, r.at);
}
