// SPDX-License-Identifier: MIT
// Gathers the irradiance of every surface that the camera sees from the accumulated volumes of all
// cascades, as packed records (pack.cl).
//
//   E = 4 I(-n) / s^2           steps
//   E = pi (alpha(-n) . c) / (alpha(-n) . f)     sweep, f the white furnace's coefficients
//
// E is at least 0. The coefficients c are interpolated trilinearly at p + offset s n, n =
// lift_normal(): n_s, or n_g if both differ by more than 20 degrees (shared/normal.h).
// docs/method.md, 'Gathering'; cascades.h has the weights of cascades.
//
// In:   places, normals   the camera's surface (surface_row.h): depths [m], or with CLPV_POINTS
//                         positions [m]
//       grids       ClpvGrid of each of `cascades` cascades, finest first
//       unit        [W/sr] of a stored 1
//       CLPV_AND_VOLUMES   packed records and occlusion bits (gather_packed.h)
//       table of G (basis/table.h), if functions are looked up
// Out:  irradiance  E [W/m^2] per pixel
// A work-item processes W pixels of a row: coordinates in lanes, then pixel by pixel, since each
// reads its own cells (gathering.h).
#include "gather/gather_packed.h"

#define CLPV_GATHERED const PackedCascade
#include "gather/gathering.h"

__kernel void gather(const ClpvView view, __global const Place* places,
                     __global const float4* normals, __global const ClpvGrid* grids,
                     const uint cascades, const float unit,
                     __global float4* irradiance CLPV_AND_VOLUMES CLPV_AND_G) {
  const PixelRow p = find_pixel_row(view);
  if (p.count == 0) return;
  Gathering g;
  CLPV_LOAD_SURFACES(view, p, places, normals, &g.surfaces);
  begin_gathering(view, &g CLPV_PASS_G);
  for (uint c = 0; c < cascades; ++c) {
    const float area = CLPV_FACE_TRANSPORT ? 0.0f : grids[c].cell * grids[c].cell;
    add_cascade(&g, grids + c, packed_cascade(c, area, unit CLPV_PASS_VOLUMES));
  }
  float outside[W];  // outside all cascades the furnace is white
  store_lanes(g.remaining, outside);
  for (uint i = 0; i < p.count; ++i) {
    float4 e = unit * g.sums[i];
    if (!CLPV_FACE_TRANSPORT)
      e = over_furnace(e + (float4)(0.0f, 0.0f, 0.0f, M_PI_F * outside[i]), M_PI_F);
    irradiance[g.surfaces.first + i] = e;
  }
}
