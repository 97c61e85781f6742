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
CLPV_INLINE float clpv_trust(const Sampled* field, const float x, const float y, const float z) {
  const float4 arriving = clpv_field_irradiance(field, x, y, z), leaving = clpv_field_irradiance(field, -x, -y, -z);
  const float in = arriving.x + arriving.y + arriving.z, out = leaving.x + leaving.y + leaving.z;
  return in >= CLPV_LEAST_ARRIVING * out ? 1.0f : in / (CLPV_LEAST_ARRIVING * out);
}

__kernel void near_points(const ClpvView view, __global const float* depths, __global const float4* normals,
                          __global const ClpvGrid* grids, const uint cascades, __global float* points) {
  const NearRow r = near_row(view, (int)get_global_id(0) - CLPV_NEAR_COLUMNS / CLPV_ABREAST,
                             (int)get_global_id(1) - CLPV_NEAR_ROWS);
  if ((uint)(r.x + CLPV_NEAR_COLUMNS) >= r.pitch || r.y >= (int)r.height + CLPV_NEAR_ROWS) return;
  const int8 x = r.x + (int8)(0, 1, 2, 3, 4, 5, 6, 7);
  const int8 inside = (x >= 0) & (x < (int)r.width) & (r.y >= 0 && r.y < (int)r.height ? -1 : 0);
  const uint8 pixel = inside ? as_uint8(r.y * (int)view.width + x) * (uint)CLPV_NEAR_STEP : (uint8)(0u);
  PixelRow p;
  p.x = convert_float8(x * CLPV_NEAR_STEP);
  p.y = (float8)((float)(r.y * CLPV_NEAR_STEP));
  Rows rows;
  gather_rows(normals, pixel, &rows);
  const float8 depth = (float8)CLPV_GATHER(depths, pixel), none = (float8)(0.0f);
  const int8 surface = inside & (depth > none);
  const Vec position = vec_masked(surface, positions(view, p, depth));
  float8 reach = none, remaining = surface ? (float8)(1.0f) : none;
  for (uint c = 0; c < cascades; ++c) {
    const ClpvGrid grid = grids[c];
    const float8 share = clpv_cascade_share(grid, position);
    reach += share * remaining * grid.cell;
    remaining *= 1.0f - share;
  }
  const Vec normal = vec(CLPV_COLUMN(rows, x), CLPV_COLUMN(rows, y), CLPV_COLUMN(rows, z));
  store_near_vectors(position, points + CLPV_NEAR_POSITION * r.plane, r.plane, r.at);
  store_near_vectors(vec_masked(surface, normal), points + CLPV_NEAR_NORMAL * r.plane, r.plane, r.at);
  vstore8(reach, 0, points + CLPV_NEAR_REACH * r.plane + r.at);
}

__kernel void near(const ClpvView view, __global const float* points, __global const float8* directions,
                   __global const float* distances, __global const float* radiances, __global float* differences,
                   CLPV_RADIANCE) {
  const NearRow r = near_row(view, get_global_id(0), get_global_id(1));
  if (!near_inside(r)) return;
  NearPoints p;
  near_points_at(points, r, &p);
  const float8 none = (float8)(0.0f);
  const int8 lit = p.reach > none;
  RadianceField here, there;
  clpv_radiance_field(CLPV_PASS_RADIANCE, p.position, (float8)(CLPV_GATHER_OFFSET), p.normal, lit, &here);
  const VecLanes n = unpack(lit, p.normal);
  float trusts[CLPV_ABREAST];
  for (int i = 0; i < CLPV_ABREAST; ++i) trusts[i] = clpv_trust(&here.at[i], n.x[i], n.y[i], n.z[i]);
  const float8 trust = vload8(0, trusts);
  const Vec lifted = vec_add_scaled(p.position, (float8)(CLPV_GATHER_OFFSET) * p.reach, p.normal);
  Vec sum = vec(none, none, none);
  float4 volumes[CLPV_ABREAST];
  for (int i = 0; i < CLPV_ABREAST; ++i) volumes[i] = 0.0f;
  for (uint k = 0; k < CLPV_NEAR_RAYS; ++k) {
    const Vec w = near_directions(directions, r, &p, k);
    const int8 hit = vload8(0, distances + k * r.plane + r.at) < (float8)(INFINITY);
    const int8 missed = lit & ~hit & (trust > none);
    clpv_radiance_field(CLPV_PASS_RADIANCE, vec_add_scaled(lifted, p.reach, w), none, p.normal, missed, &there);
    const VecLanes back = unpack(lit, vec_times(w, (float8)(-1.0f)));
    float shares[CLPV_ABREAST];
    vstore8(hit ? (float8)(1.0f) : trust, 0, shares);
    for (int i = 0; i < CLPV_ABREAST; ++i) {
      if (!(shares[i] > 0.0f)) continue;
      Sampled change = there.at[i];
#define CLPV_DO(j, even, odd) change.p##j -= here.at[i].p##j;
      CLPV_EACH_PAIR(CLPV_DO)
#undef CLPV_DO
      volumes[i] += shares[i] * clpv_radiance(&change, back.x[i], back.y[i], back.z[i]);
    }
    const Vec met = near_vectors(radiances + 3 * k * r.plane, r.plane, r.at);
    sum = vec_add_scaled(sum, (float8)(1.0f), vec_masked(hit & lit, met));
  }
  float x[CLPV_ABREAST], y[CLPV_ABREAST], z[CLPV_ABREAST];
  for (int i = 0; i < CLPV_ABREAST; ++i) x[i] = volumes[i].x, y[i] = volumes[i].y, z[i] = volumes[i].z;
  sum = vec(sum.x + vload8(0, x), sum.y + vload8(0, y), sum.z + vload8(0, z));
  store_near_vectors(vec_times(sum, (float8)(M_PI_F / CLPV_NEAR_RAYS)), differences, r.plane, r.at);
}
