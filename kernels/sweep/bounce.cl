// SPDX-License-Identifier: MIT
// Reflects swept light off the surfaces in a cascade's cells: one more bounce, or all bounces as a
// truncated Neumann series.
//
//   I' = I + R D              inject_reflected       one bounce; only R D with `injected_share` 0
//   I' = I + R D_1 + S D_2    inject_series          all bounces in the coarsest cascade; D_2:
//                                                    incident flux of R D_1
//   S = R (1 + X)             extend_series          X: flux that other surfaces return of 1 W
//                                                    leaving a face
//   I' = I + R D_coarser / 4  inject_interpolated    all bounces in a finer cascade
//   I' = R or S               inject_unit            faces emit what they reflect of 1 W
//
// docs/method.md, 'More bounces'. D [W] is the incident flux on a face, R in [0, 1] the reflectance
// of a face per channel, I the injected light, I' the sources of the next sweep. By reciprocity X
// is the incident flux while every face emits what it reflects of 1 W: inject_unit, a sweep along
// 24 directions and extend_series add one term of the series. X depends only on geometry. A face of
// normal a that receives D_a (face_fluxes.h) emits, projected on the basis,
//   I(w) = Phi_a max(0, w.a) / pi,   Phi_a = R_a D_a
//
// In:   swept             L s^2 [W/sr] of 3 channels and 24 bins (sweep_layout.h)
//       reflectors, series  R, S: volumes of six numbers per cell and channel, faces as in
//                           shared/reflectors.h
//       incident          D [W] of the next coarser cascade: a bordered volume for each channel and
//                         face (sweep_collect.cl)
//       injected          I: light volume [W/sr]
// Out:  bounced           I': light volume [W/sr]
// From the host (host/codegen/sweep_source.cpp): Coefficients of the basis, CLPV_LOBES, the lobe of
// 1 W about each face's normal, and the text for face_fluxes.h.
// A work-item computes a tile of W x W cells of a slice and channel.
#include "volume/coefficients.h"
#include "sweep/coarse_to_fine.h"
#include "sweep/face_fluxes.h"
#include "volume/light.h"

#define CLPV_VOLUME faces
#define CLPV_VOLUME_CELL FaceFluxes
#define CLPV_VOLUME_COUNT CLPV_CELL_FACES
#include "volume/instance.h"

__constant const float lobes[CLPV_CELL_FACES][CLPV_N] = CLPV_LOBES;

// Flux [W] that leaves each face of a cell: incident flux times reflectance.
CLPV_INLINE FaceFluxes reflect_flux(const FaceFluxes incident, const FaceFluxes reflectance) {
  FaceFluxes flux;
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a) flux.c[a] = incident.c[a] * reflectance.c[a];
  return flux;
}

CLPV_INLINE FaceFluxes add_fluxes(const FaceFluxes a, const FaceFluxes b) {
  FaceFluxes sum;
#pragma unroll
  for (int i = 0; i < CLPV_CELL_FACES; ++i) sum.c[i] = a.c[i] + b.c[i];
  return sum;
}

// R (1 + X)
CLPV_INLINE FaceFluxes sum_series(const FaceFluxes returned, const FaceFluxes reflectance) {
  FaceFluxes series;
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a) series.c[a] = reflectance.c[a] * (1.0f + returned.c[a]);
  return series;
}

// Intensity [W/sr] of light that leaves each face as a lobe.
CLPV_INLINE Coefficients reflected_intensity(const FaceFluxes flux) {
  Coefficients c = zero_coefficients();
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a) c = add_row(c, flux.c[a], lobes[a]);
  return c;
}

// Tile of a work-item: its first cell, its channel, and the index `first` of the channel's bins.
typedef struct {
  int x, y, z, channel, first;
  int rows;  // inside the grid; 0: the tile is outside
} Tile;

CLPV_INLINE Tile find_tile(void) {
  Tile t;
  t.x = W * (int)get_global_id(0), t.y = W * (int)get_global_id(1);
  t.z = (int)get_global_id(2) % CLPV_GRID, t.channel = (int)get_global_id(2) / CLPV_GRID;
  t.first = t.channel * CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME;
  t.rows = t.x < CLPV_GRID ? clamp(CLPV_GRID - t.y, 0, W) : 0;
  return t;
}

// Incident flux on the cells in row r of a tile of swept light.
CLPV_INLINE FaceFluxes load_incident_flux(CLPV_BUFFER_IN swept, const SweepTile* x_bins,
                                          const Tile t, const int r) {
  return incident_flux(load_bins(swept + t.first, x_bins, r, t.x, t.y + r, t.z));
}

__kernel void inject_reflected(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors,
                               CLPV_VOLUME_IN injected, const float injected_share,
                               CLPV_VOLUME_OUT bounced) {
  const Tile t = find_tile();
  if (t.rows == 0) return;
  SweepTile bins[CLPV_AXIS_BINS];
  load_x_bins(swept + t.first, t.x, t.y, t.z, bins);
  for (int r = 0; r < t.rows; ++r) {
    const Coefficients reflected =
        reflected_intensity(reflect_flux(load_incident_flux(swept, bins, t, r),
                                         faces_load(reflectors, t.channel, t.x, t.y + r, t.z)));
    light_store(
        bounced, t.channel, t.x, t.y + r, t.z,
        add_scaled(reflected, injected_share, light_load(injected, t.channel, t.x, t.y + r, t.z)));
  }
}

__kernel void inject_series(CLPV_BUFFER_IN first_swept, CLPV_BUFFER_IN second_swept,
                            CLPV_VOLUME_IN reflectors, CLPV_VOLUME_IN series,
                            CLPV_VOLUME_IN injected, CLPV_VOLUME_OUT bounced) {
  const Tile t = find_tile();
  if (t.rows == 0) return;
  SweepTile first[CLPV_AXIS_BINS], second[CLPV_AXIS_BINS];
  load_x_bins(first_swept + t.first, t.x, t.y, t.z, first);
  load_x_bins(second_swept + t.first, t.x, t.y, t.z, second);
  for (int r = 0; r < t.rows; ++r) {
    const FaceFluxes flux =
        add_fluxes(reflect_flux(load_incident_flux(first_swept, first, t, r),
                                faces_load(reflectors, t.channel, t.x, t.y + r, t.z)),
                   reflect_flux(load_incident_flux(second_swept, second, t, r),
                                faces_load(series, t.channel, t.x, t.y + r, t.z)));
    light_store(bounced, t.channel, t.x, t.y + r, t.z,
                add_coefficients(light_load(injected, t.channel, t.x, t.y + r, t.z),
                                 reflected_intensity(flux)));
  }
}

__kernel void inject_unit(CLPV_VOLUME_IN series, CLPV_VOLUME_OUT bounced) {
  const Tile t = find_tile();
  for (int r = 0; r < t.rows; ++r)
    light_store(bounced, t.channel, t.x, t.y + r, t.z,
                reflected_intensity(faces_load(series, t.channel, t.x, t.y + r, t.z)));
}

__kernel void extend_series(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors,
                            CLPV_VOLUME_OUT series) {
  const Tile t = find_tile();
  if (t.rows == 0) return;
  SweepTile bins[CLPV_AXIS_BINS];
  load_x_bins(swept + t.first, t.x, t.y, t.z, bins);
  for (int r = 0; r < t.rows; ++r)
    faces_store(series, t.channel, t.x, t.y + r, t.z,
                sum_series(load_incident_flux(swept, bins, t, r),
                           faces_load(reflectors, t.channel, t.x, t.y + r, t.z)));
}

// Incident flux on one face of a row of finer cells from (x, y, z) on, from the coarser cells'
// faces: trilinear, and a quarter, since a finer face has a quarter of the area.
CLPV_INLINE realW interpolate_flux(CLPV_BUFFER_IN incident, const int x, const int y, const int z) {
  CLPV_BUFFER_IN from = incident + bordered_index(lower_cell(z), lower_cell(y), lower_cell(x));
  const float tz = upper_weight(z), ty = upper_weight(y);
  const realW v = interpolate_rows(from, 0, CLPV_SWEEP_PITCH, CLPV_BORDERED_PLANE, ty, tz);
#if W == 8
  return 0.25f * (x & 1 ? interpolate_odd(v) : interpolate_even(v));
#else
  const float tx = upper_weight(x);
  return 0.25f * ((1.0f - tx) * v +
                  tx * interpolate_rows(from, 1, CLPV_SWEEP_PITCH, CLPV_BORDERED_PLANE, ty, tz));
#endif
}

CLPV_INLINE FaceFluxes interpolate_faces(CLPV_BUFFER_IN incident, const int x, const int y,
                                         const int z) {
  FaceFluxes flux;
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a)
    flux.c[a] = interpolate_flux(incident + a * CLPV_BORDERED_VOLUME, x, y, z);
  return flux;
}

// dx, dy, dz: offset of the grid's origin from the coarser one's, in finer cells
// (coarse_to_fine.h).
__kernel void inject_interpolated(CLPV_BUFFER_IN incident, const int dx, const int dy, const int dz,
                                  CLPV_VOLUME_IN reflectors, CLPV_VOLUME_IN injected,
                                  CLPV_VOLUME_OUT bounced) {
  const Tile t = find_tile();
  CLPV_BUFFER_IN fluxes = incident + t.channel * CLPV_CELL_FACES * CLPV_BORDERED_VOLUME;
  for (int r = 0; r < t.rows; ++r) {
    const FaceFluxes flux =
        reflect_flux(interpolate_faces(fluxes, t.x + dx, t.y + r + dy, t.z + dz),
                     faces_load(reflectors, t.channel, t.x, t.y + r, t.z));
    light_store(bounced, t.channel, t.x, t.y + r, t.z,
                add_coefficients(light_load(injected, t.channel, t.x, t.y + r, t.z),
                                 reflected_intensity(flux)));
  }
}
