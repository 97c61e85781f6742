// SPDX-License-Identifier: MIT
// Near field: rays find light from surfaces nearer than R, which replaces the volumes'
// (docs/method.md, 'Near field').
//
//   D = (pi / K) sum_k d(w_k)                                [W/m^2], w_k cosine-distributed about
//                                                            the normal n
//   d(w) = L_hit - L(p', -w)                 if a surface is met along w within R; at p' all
//                                            directions share the denominator of E
//   d(w) = q (L(o + R w, -w) - L(p', -w))    else, q the weight of the correction (miss_weight)
//   p' = p + h s n_g                         n_g: lift_normal() (shared/normal.h)
//   o = p + 0.15 R n_g
//
// Nothing stands on the way from o + R w to m = p + R w / 2 + 0.22 R n_g, whose nearest sample
// point is on p's side (gather_packed.h). Where m and the point 0.85 R from p towards the eye see
// no cell in common, m is behind another surface, and both have no part along n_g.
// h: CLPV_GATHER_OFFSET. R and s: edge of a cell of the cascades at p, blended like their light.
// near_trace.cl finds hits, near_light.cl their radiance; radiance.h has L. near_filter.cl adds D
// to the irradiance E that is gathered at p.
//
// In:   points, directions    near_layout.h
//       distances             per ray: distance of the hit [m], INFINITY without one
//       radiances             L_hit [W/m^2/sr] per ray: three planes for each k
//       CLPV_RADIANCE         volumes
// Out:  light                 D and E (shared/near.h)
// A work-item processes W pixels of a row.
#include "gather/near_layout.h"
#include "gather/radiance.h"
#include "raster/surface_row.h"

// Minimum ratio of arriving to leaving irradiance at which misses get full weight.
__constant const float least_arriving = 0.5f;

// Distances of o and m along n_g [R]. The nearest sample point is up to 0.217 R away.
__constant const float end_lift = 0.15f, middle_lift = 0.22f;

// Weight in [0, 1] of the correction for rays that miss. In nine harmonics, light that leaves a
// bright surface partly also arrives at it. Where much more leaves than arrives, the correction
// would be a difference of two such errors. (x, y, z) = n.
CLPV_INLINE float miss_weight(const Sampled* field, const float4 arriving, const float x,
                              const float y, const float z) {
  const float4 leaving = max(weigh(cosine_integrals(x, y, z), *field), 0.0f);
  const float in = arriving.x + arriving.y + arriving.z, out = leaving.x + leaving.y + leaving.z;
  return in >= least_arriving * out ? 1.0f : in / (least_arriving * out);
}

#if CLPV_VISIBLE
// Sample point of visibility about p [m] along an axis [quarters of cells].
static inline int quarter_at(const ClpvGrid grid, const int axis, const float p) {
  const float at = (p - grid.origin[axis]) * (4.0f / grid.cell) - 2.0f;
  return (int)clamp(at, 0.0f, (float)max(4 * CLPV_GRID - 5, 0));
}

// Whether sample points of visibility at points i of p and q [m] see a cell in common; true if they
// are farther apart than cells that have one.
static inline bool see_a_cell(const ClpvGrid grid, __global const uchar* occluded,
                              const VecLanes* p, const VecLanes* q, const int i) {
  const int a = quarter_at(grid, 0, p->x[i]), b = quarter_at(grid, 1, p->y[i]),
            c = quarter_at(grid, 2, p->z[i]), u = quarter_at(grid, 0, q->x[i]),
            v = quarter_at(grid, 1, q->y[i]), w = quarter_at(grid, 2, q->z[i]);
  const int x = (u >> 2) - (a >> 2), y = (v >> 2) - (b >> 2), z = (w >> 2) - (c >> 2);
  if (max(abs(x), max(abs(y), abs(z))) > 1u) return true;
  return (seen_cells(occluded, CLPV_GRID, a, b, c) &
          cells_from(seen_cells(occluded, CLPV_GRID, u, v, w), x, y, z)) != 0;
}
#endif

// Mask of the `wanted` lanes where the points `at` [m] see a cell that those 0.85 R along `eye`
// see, in the finest cascade that lights them; of all lanes without a way to the eye.
CLPV_INLINE intW in_sight(CLPV_RADIANCE, const NearPoints* p, const Vec eye, const Vec at,
                          const intW wanted) {
#if CLPV_VISIBLE
  const realW far = sqrt(vec_dot(eye, eye)), most = 0.85f * p->reach;
  const Vec clear = vec_add_scaled(p->position, far > most ? most / far : ONE, eye);
  const VecLanes there = unpack(wanted, clear), here = unpack(wanted, at);
  float reach[W], seen[W];
  store_lanes((wanted & (far > ZERO)) ? p->reach : ZERO, reach);
  for (int i = 0; i < W; ++i) {
    seen[i] = 1.0f;
    if (!(reach[i] > 0.0f)) continue;
    uint c = 0;
    while (c + 1 < cascades && grids[c + 1].cell <= 1.0001f * reach[i]) ++c;
    seen[i] = see_a_cell(grids[c], CLPV_OCCLUDED_OF(c), &there, &here, i) ? 1.0f : 0.0f;
  }
  return load_lanes(seen) > ZERO;
#else
  return (intW)(-1);
#endif
}

__kernel void near(const ClpvView view, __global const float* points,
                   __global const realW* directions, __global const float* distances,
                   __global const float* radiances, __global float* light, CLPV_RADIANCE) {
  const PlaneRow r = find_plane_row(view, get_global_id(0), get_global_id(1));
  if (!row_has_pixels(r)) return;
  NearPoints p;
  load_near_points(points, r, &p);
  const intW lit = p.reach > ZERO;
  if (lane_bits(lit) == 0u) {
    for (uint i = 0; i < CLPV_NEAR_LIGHT_PLANES; ++i) store_lanes(ZERO, light + i * r.plane + r.at);
    return;
  }
  const Vec eye = towards_eye(view, p.position);
  RadianceField here, there;
  sample_radiance(CLPV_PASS_RADIANCE, p.position, (realW)(CLPV_GATHER_OFFSET), p.lift, eye, eye,
                  lit, &here);
  const VecLanes n = unpack(lit, p.normal);
  float trusts[W], x[W], y[W], z[W];
  for (int i = 0; i < W; ++i) {
    const float4 arriving =
        max(weigh(cosine_integrals(-n.x[i], -n.y[i], -n.z[i]), here.at[i]), 0.0f);
    trusts[i] = miss_weight(&here.at[i], arriving, n.x[i], n.y[i], n.z[i]);
    const float mean = 1.0f / furnace_divisor(arriving.w * M_1_PI_F);
    for (int j = 0; j < CLPV_PAIRS; ++j) here.at[i].pair[j] *= mean;
    x[i] = mean * arriving.x, y[i] = mean * arriving.y, z[i] = mean * arriving.z;
  }
  store_plane_vectors(vec(load_lanes(x), load_lanes(y), load_lanes(z)),
                      light + CLPV_NEAR_GATHERED * r.plane, r.plane, r.at);
  const realW trust = load_lanes(trusts);
  Vec sum = vec(ZERO, ZERO, ZERO);
  float4 volumes[W];
  for (int i = 0; i < W; ++i) volumes[i] = 0.0f;
  for (uint k = 0; k < CLPV_NEAR_RAYS; ++k) {
    const Vec w = find_near_directions(directions, r, &p, k);
    const intW hit = load_lanes(distances + k * r.plane + r.at) < (realW)(INFINITY);
    const intW missed = lit & (hit == 0) & (trust > ZERO);
    const Vec up = vec_times(p.lift, p.reach),
              along = vec_add_scaled(p.position, 0.5f * p.reach, w);
    const intW open =
        in_sight(CLPV_PASS_RADIANCE, &p, eye, vec_add_scaled(along, middle_lift, up), missed);
    const Vec off = vec_masked(open, up),
              end = vec_add_scaled(vec_add_scaled(p.position, p.reach, w), end_lift, off),
              clear = vec_minus(vec_add_scaled(along, middle_lift, off), end);
    sample_radiance(CLPV_PASS_RADIANCE, end, ZERO, p.normal, clear, eye, missed, &there);
    const VecLanes back = unpack(lit, vec_times(w, (realW)(-1.0f)));
    float shares[W];
    store_lanes(lit ? (hit ? ONE : trust) : ZERO, shares);
    for (int i = 0; i < W; ++i) {
      if (!(shares[i] > 0.0f)) continue;
      const Coefficients along = basis_functions(back.x[i], back.y[i], back.z[i]);
      volumes[i] += shares[i] * (radiance_along(&there.at[i], along) -  // 0: a hit
                                 weigh(along, here.at[i]));
    }
    const Vec met = load_plane_vectors(radiances + 3 * k * r.plane, r.plane, r.at);
    sum = vec_add_scaled(sum, ONE, vec_masked(hit & lit, met));
  }
  for (int i = 0; i < W; ++i) x[i] = volumes[i].x, y[i] = volumes[i].y, z[i] = volumes[i].z;
  sum = vec(sum.x + load_lanes(x), sum.y + load_lanes(y), sum.z + load_lanes(z));
  store_plane_vectors(vec_times(sum, (realW)(M_PI_F / CLPV_NEAR_RAYS)),
                      light + CLPV_NEAR_DIFFERENCE * r.plane, r.plane, r.at);
}
