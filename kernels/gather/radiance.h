// SPDX-License-Identifier: MIT
// Radiance from the packed volumes of swept light.
//
//   L(p, w) = Y(w) . C(p) / Y(w) . F(p)                     [W/m^2/sr], light that travels along w
//   E(p, n) = pi max(0, alpha(-n) . C(p)) / alpha(-n) . F(p)      [W/m^2]
//
// C = c / s^2 and the coefficients F of the white furnace are interpolated trilinearly, cells that
// p cannot see left out, and means over cascades by their shares. Outside all cascades the furnace
// is white. over_furnace() divides.
//
// Where few surfaces are in sight along w, Y . F < 1/2, the rest to 1/2 has the mean radiance of
// all directions, C_0 / F_0. L may be negative: it is the light's projection on nine harmonics.
// docs/method.md, 'The sweep', 'Gathering'.
#pragma once

#include "basis/basis.h"
#include "gather/gather_packed.h"

// Parameters: grids and packed volumes of all cascades, and the unit [W/sr] of a stored 1.
#define CLPV_RADIANCE \
  __global const ClpvGrid *grids, const uint cascades, const float unit CLPV_AND_VOLUMES
#define CLPV_PASS_RADIANCE grids, cascades, unit CLPV_PASS_VOLUMES

// C and, as fourth numbers, F at W points.
typedef struct {
  Sampled at[W];
} RadianceField;

CLPV_INLINE void add_field(const PackedCascade cascade, const SamplePoints* points,
                           const realW weight, RadianceField* field) {
  float weights[W];
  store_lanes(weight, weights);
  for (int i = 0; i < W; ++i) {
    if (!(weights[i] > 0.0f)) continue;
    Sampled sampled;
    const float scale = weights[i] * sample_cells(cascade, points, i, &sampled);
    for (int j = 0; j < CLPV_PAIRS; ++j) field->at[i].pair[j] += scale * sampled.pair[j];
  }
}

// C at the points position + offset * s * lift of each cascade, s its cell; cascades have their
// shares at `position`. `clear` [m] and `eye`: as in gather_packed.h. 0 outside the mask `wanted`.
CLPV_INLINE void sample_radiance(CLPV_RADIANCE, const Vec position, const realW offset,
                                 const Vec lift, const Vec clear, const Vec eye,
                                 const intW wanted, RadianceField* field) {
  realW remaining = wanted ? (realW)(unit) : ZERO;
  for (int i = 0; i < W; ++i) {
    for (int j = 0; j < CLPV_PAIRS; ++j) field->at[i].pair[j] = 0.0f;
  }
  for (uint c = 0; c < cascades; ++c) {
    const ClpvGrid grid = grids[c];
    const realW share = cascade_share(grid, position);
    const float area = grid.cell * grid.cell;
    const realW weight = share * remaining * (1.0f / area);
    remaining *= 1.0f - share;
    if (no_lane(weight > ZERO)) continue;
    SamplePoints points;
    find_sample_points(find_cascade_points(grid, position, offset, lift),
                       vec_times(clear, (realW)(1.0f / grid.cell)), eye, &points);
    add_field(packed_cascade(c, area, unit CLPV_PASS_VOLUMES), &points, weight, field);
  }
  float outside[W];
  store_lanes(remaining * (CLPV_EVEN_LIGHT / unit), outside);
  for (int i = 0; i < W; ++i) field->at[i].pair[0].s3 += outside[i];
}

// L(p, w) for each channel, and 0; y = Y(w).
CLPV_INLINE float4 radiance_along(const Sampled* field, const Coefficients y) {
  const float4 light = weigh(y, *field), mean = over_furnace(y.c[0] * field->pair[0].lo, 1.0f);
  const float f = fmax(light.w, 0.0f), rest = fmax(0.5f - f, 0.0f);
  return (float4)((light.xyz + rest * mean.xyz) * (1.0f / (f + rest)), 0.0f);
}

// E(p, n) for each channel, and 0; (x, y, z) = n.
CLPV_INLINE float4 field_irradiance(const Sampled* field, const float x, const float y,
                                    const float z) {
  return over_furnace(max(weigh(cosine_integrals(-x, -y, -z), *field), 0.0f), M_PI_F);
}
