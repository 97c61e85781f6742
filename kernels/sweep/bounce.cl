// SPDX-License-Identifier: MIT
// Reflects swept light off the surfaces in a cascade's cells: one more bounce, or all bounces as a truncated Neumann
// series.
//
//   B = I + R D               inject_reflected       one bounce; only R D with `injected_share` 0
//   B = I + R D_1 + S D_2     inject_series          all bounces in the coarsest cascade; D_2: incident flux of R D_1
//   S = R (1 + E)             extend_series          E: flux that other surfaces return of 1 W leaving a face
//   B = I + R D_coarser / 4   inject_interpolated    all bounces in a finer cascade
//   B = R or S                inject_unit            faces emit what they reflect of 1 W
//
// docs/method.md, 'More bounces'. D [W] is the incident flux on a face, R in [0, 1] the reflectance of a face per
// channel, I the injected light, B the sources of the next sweep. By reciprocity E is the incident flux while every face
// emits what it reflects of 1 W: inject_unit, a sweep along 24 directions and extend_series add one term of the series.
// E depends only on geometry. Of light L_b in bins b (w_b, Omega_b) a face of normal a receives
//   D_a = sum_b Omega_b max(0, -w_b.a) L_b s^2
// and it emits a flux Phi as the lobe Phi max(0, w.a) / pi, projected on the basis.
//
// In:   swept             L s^2 [W/sr] of 3 channels and 24 bins (sweep_layout.h)
//       reflectors, series  R, S: volumes of six numbers per cell and channel, faces as in shared/reflectors.h
//       incident          D [W] of the next coarser cascade: a bordered volume for each channel and face
//                         (sweep_collect.cl)
//       injected          I: light volume [W/sr]
// Out:  bounced           B: light volume [W/sr]
// From the host (host/codegen/sweep_source.cpp): Coefficients of the basis; struct Bins; CLPV_EACH_X_BIN, _Y_, _Z_;
// struct FaceFluxes; FaceFluxes incident_flux(Bins) [W]; Coefficients reflected_intensity(FaceFluxes) [W/sr].
// A work-item computes a tile of W x W cells of a slice and channel.
#include "volume/coefficients.h"
#include "sweep/coarse_to_fine.h"
#include "shared/reflectors.h"
#include "shared/sweep.h"
#include "sweep/sweep_tiles.h"
#include "volume/light.h"

#define CLPV_VOLUME faces
#define CLPV_VOLUME_N CLPV_GRID
#define CLPV_VOLUME_CELL FaceFluxes
#define CLPV_VOLUME_EACH CLPV_EACH_FACE_FLUX
#define CLPV_VOLUME_COUNT CLPV_CELL_FACES
#include "volume/instance.h"

// Flux [W] that leaves each face of a cell: incident flux times reflectance.
CLPV_INLINE FaceFluxes reflect_flux(const FaceFluxes incident, const FaceFluxes reflectance) {
  FaceFluxes flux;
#define CLPV_DO(i) flux.c##i = incident.c##i * reflectance.c##i;
  CLPV_EACH_FACE_FLUX(CLPV_DO)
#undef CLPV_DO
  return flux;
}

CLPV_INLINE FaceFluxes add_fluxes(const FaceFluxes a, const FaceFluxes b) {
  FaceFluxes sum;
#define CLPV_DO(i) sum.c##i = a.c##i + b.c##i;
  CLPV_EACH_FACE_FLUX(CLPV_DO)
#undef CLPV_DO
  return sum;
}

// R (1 + E)
CLPV_INLINE FaceFluxes sum_series(const FaceFluxes returned, const FaceFluxes reflectance) {
  FaceFluxes series;
#define CLPV_DO(i) series.c##i = reflectance.c##i * (1.0f + returned.c##i);
  CLPV_EACH_FACE_FLUX(CLPV_DO)
#undef CLPV_DO
  return series;
}

// Declares the tile's first cell (x, y, z), its channel, and the index `first` of the channel's volumes.
#define CLPV_THIS_TILE                                                                          \
  const int x = W * (int)get_global_id(0), y = W * (int)get_global_id(1);     \
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID; \
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;                                                 \
  const int first = channel * CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME;

// Incident flux on the cells in row r of tiles of `volumes`.
#define CLPV_INCIDENT_FLUX(volumes, tiles) incident_flux(load_bins(volumes, tiles, r, x, y + r, z))

__kernel void inject_reflected(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors, CLPV_VOLUME_IN injected,
                               const float injected_share, CLPV_VOLUME_OUT bounced) {
  CLPV_THIS_TILE
  SweepTile tiles[CLPV_X_BINS];
  load_x_bins(swept + first, x, y, z, tiles);
  for (int r = 0; r < W; ++r) {
    if (y + r >= CLPV_GRID) break;
    const Coefficients reflected = reflected_intensity(reflect_flux(
        CLPV_INCIDENT_FLUX(swept + first, tiles), faces_load(reflectors, channel, x, y + r, z)));
    light_store(bounced, channel, x, y + r, z,
                add_scaled(reflected, injected_share, light_load(injected, channel, x, y + r, z)));
  }
}

__kernel void inject_series(CLPV_BUFFER_IN first_swept, CLPV_BUFFER_IN second_swept, CLPV_VOLUME_IN reflectors,
                            CLPV_VOLUME_IN series, CLPV_VOLUME_IN injected, CLPV_VOLUME_OUT bounced) {
  CLPV_THIS_TILE
  SweepTile tiles[CLPV_X_BINS], second[CLPV_X_BINS];
  load_x_bins(first_swept + first, x, y, z, tiles);
  load_x_bins(second_swept + first, x, y, z, second);
  for (int r = 0; r < W; ++r) {
    if (y + r >= CLPV_GRID) break;
    const FaceFluxes flux =
        add_fluxes(reflect_flux(CLPV_INCIDENT_FLUX(first_swept + first, tiles),
                                faces_load(reflectors, channel, x, y + r, z)),
                        reflect_flux(CLPV_INCIDENT_FLUX(second_swept + first, second),
                                     faces_load(series, channel, x, y + r, z)));
    light_store(bounced, channel, x, y + r, z,
                add_coefficients(light_load(injected, channel, x, y + r, z), reflected_intensity(flux)));
  }
}

__kernel void inject_unit(CLPV_VOLUME_IN series, CLPV_VOLUME_OUT bounced) {
  CLPV_THIS_TILE
  (void)first;
  for (int r = 0; r < W; ++r) {
    if (y + r >= CLPV_GRID) break;
    light_store(bounced, channel, x, y + r, z,
                reflected_intensity(faces_load(series, channel, x, y + r, z)));
  }
}

__kernel void extend_series(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors, CLPV_VOLUME_OUT series) {
  CLPV_THIS_TILE
  SweepTile tiles[CLPV_X_BINS];
  load_x_bins(swept + first, x, y, z, tiles);
  for (int r = 0; r < W; ++r) {
    if (y + r >= CLPV_GRID) break;
    const FaceFluxes returned = CLPV_INCIDENT_FLUX(swept + first, tiles);
    faces_store(series, channel, x, y + r, z, sum_series(returned, faces_load(reflectors, channel, x, y + r, z)));
  }
}

// Incident flux on one face of a row of finer cells from (x, y, z) on, from the coarser cells' faces: trilinear, and a
// quarter, since a finer face has a quarter of the area.
CLPV_INLINE realW interpolate_flux(CLPV_BUFFER_IN incident, const int x, const int y, const int z) {
  CLPV_BUFFER_IN from = incident + bordered_index(CLPV_LOWER(z), CLPV_LOWER(y), CLPV_LOWER(x));
  const float tz = CLPV_UPPER_WEIGHT(z), ty = CLPV_UPPER_WEIGHT(y);
#define CLPV_BILINEAR(at)                                                                                          \
  ((1.0f - tz) * ((1.0f - ty) * CLPV_SWEEP_LOAD(from, at) + ty * CLPV_SWEEP_LOAD(from, (at) + CLPV_SWEEP_PITCH)) + \
   tz * ((1.0f - ty) * CLPV_SWEEP_LOAD(from, (at) + CLPV_BORDERED_PLANE) +                                         \
         ty * CLPV_SWEEP_LOAD(from, (at) + CLPV_BORDERED_PLANE + CLPV_SWEEP_PITCH)))
  const realW v = CLPV_BILINEAR(0);
#if W == 8
  return 0.25f * (x & 1 ? CLPV_ODD(v) : CLPV_EVEN(v));
#else
  const float tx = CLPV_UPPER_WEIGHT(x);
  return 0.25f * ((1.0f - tx) * v + tx * CLPV_BILINEAR(1));
#endif
}

CLPV_INLINE FaceFluxes interpolate_faces(CLPV_BUFFER_IN incident, const int x, const int y, const int z) {
  FaceFluxes flux;
#define CLPV_DO(i) flux.c##i = interpolate_flux(incident + i * CLPV_BORDERED_VOLUME, x, y, z);
  CLPV_EACH_FACE_FLUX(CLPV_DO)
#undef CLPV_DO
  return flux;
}

// dx, dy, dz: offset of the grid's origin from the coarser one's, in finer cells (coarse_to_fine.h).
__kernel void inject_interpolated(CLPV_BUFFER_IN incident, const int dx, const int dy, const int dz,
                                  CLPV_VOLUME_IN reflectors, CLPV_VOLUME_IN injected, CLPV_VOLUME_OUT bounced) {
  CLPV_THIS_TILE
  (void)first;
  CLPV_BUFFER_IN fluxes = incident + channel * CLPV_CELL_FACES * CLPV_BORDERED_VOLUME;
  for (int r = 0; r < W; ++r) {
    if (y + r >= CLPV_GRID) break;
    const FaceFluxes flux = reflect_flux(interpolate_faces(fluxes, x + dx, y + r + dy, z + dz),
                                         faces_load(reflectors, channel, x, y + r, z));
    light_store(bounced, channel, x, y + r, z,
                add_coefficients(light_load(injected, channel, x, y + r, z), reflected_intensity(flux)));
  }
}
