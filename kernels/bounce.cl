// SPDX-License-Identifier: MIT
// Reflects swept light off the surfaces in a cascade's cells: one more bounce, or all bounces as a truncated Neumann
// series.
//
//   I += R D                   inject_reflected       one bounce
//   I += R D_1 + S D_2         inject_series          all bounces in the coarsest cascade; D_2: incident flux of R D_1
//   S  = R (1 + E)             extend_series          E: flux that other surfaces return of 1 W leaving a face
//   I += R D_coarser / 4       inject_interpolated    all bounces in a finer cascade
//   I += R or S                inject_unit            faces emit what they reflect of 1 W
//
// docs/method.md, 'More bounces'. D [W] is the incident flux on a face, R in [0, 1] the reflectance of a face per
// channel, I the sources of a sweep. By reciprocity E is the incident flux while every face emits what it reflects of 1
// W: inject_unit, a sweep along 24 directions and extend_series add one term of the series. E depends on geometry
// alone.
//
// Flux and intensity of bins b (w_b, Omega_b) and faces a:
//   D_a = sum_b Omega_b max(0, -w_b.a) L_b s^2,   I_b = sum_a Phi_a max(0, w_b.a) / sum_b' Omega_b' max(0, w_b'.a)
//
// In:      swept             L s^2 [W/sr] of 3 channels and 24 bins (sweep_layout.h)
//          reflectors, series  R, S: light volumes of six numbers per cell and channel, faces as in shared/reflectors.h
//          incident          D [W] of the next coarser cascade: a bordered volume for each channel and face
//                            (sweep_collect.cl)
// In, out: sources           I [W/sr] of 3 channels and 24 bins (sweep_layout.h)
// From the host (host/codegen/sweep_source.cpp): Coefficients, of six faces; struct Bins; CLPV_EACH_X_BIN, _Y_, _Z_
// (sweep_source.cl); Coefficients clpv_incident_flux(Bins) [W]; Bins clpv_reflected_intensity(Coefficients) [W/sr].
// A work-item computes a tile of CLPV_LANES x CLPV_LANES cells of a slice and channel; tiles without surfaces are
// skipped.
#include "coefficients.h"
#include "coarse_to_fine.h"
#include "shared/sweep.h"
#include "sweep_tiles.h"
#include "volume/light.h"

CLPV_INLINE Bins clpv_zero_bins(void) {
  Bins bins;
#define CLPV_DO(b) bins.c##b = 0.0f;
  CLPV_EACH_BIN(CLPV_DO)
#undef CLPV_DO
  return bins;
}

// Flux [W] that leaves each face of a cell: incident flux times reflectance.
CLPV_INLINE Coefficients clpv_reflected_flux(const Coefficients incident, const Coefficients reflectance) {
  Coefficients flux;
#define CLPV_DO(i) flux.c##i = incident.c##i * reflectance.c##i;
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return flux;
}

// R (1 + E)
CLPV_INLINE Coefficients clpv_series(const Coefficients returned, const Coefficients reflectance) {
  Coefficients series;
#define CLPV_DO(i) series.c##i = reflectance.c##i * (1.0f + returned.c##i);
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return series;
}

// Returns nonzero if any face of a tile's cells reflects.
CLPV_INLINE int clpv_tile_reflects(CLPV_VOLUME_IN reflectors, const int channel, const int x, const int y,
                                   const int z) {
  CLPV_REAL all = 0.0f;
  for (int r = 0; r < CLPV_LANES; ++r) {
    if (y + r >= CLPV_GRID) break;
    const Coefficients reflectance = light_load(reflectors, channel, x, y + r, z);
#define CLPV_DO(i) all += reflectance.c##i;
    CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  }
#if CLPV_LANES == 8
  const float4 four = all.lo + all.hi;
  return four.x + four.y + four.z + four.w != 0.0f;
#else
  return all != 0.0f;
#endif
}

// Adds a row of cells to the bins across y and z.
CLPV_INLINE void clpv_add_row(const Bins bins, CLPV_BUFFER_OUT sources, const int x, const int y, const int z) {
#define CLPV_ADD(b, at)                                 \
  CLPV_SWEEP_STORE(sources + b * CLPV_SWEEP_VOLUME, at, \
                   CLPV_WITHIN(x, CLPV_SWEEP_LOAD(sources + b * CLPV_SWEEP_VOLUME, at) + bins.c##b));
#define CLPV_DO(b) CLPV_ADD(b, clpv_sweep_at(z, y, x))
  CLPV_EACH_Z_BIN(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(b) CLPV_ADD(b, clpv_sweep_at(y, z, x))
  CLPV_EACH_Y_BIN(CLPV_DO)
#undef CLPV_DO
}

// Adds a tile to the bins across x, transposed.
CLPV_INLINE void clpv_add_x_bins(const SweepTile* tiles, CLPV_BUFFER_OUT sources, const int x, const int y,
                                 const int z) {
  for (int b = 0; b < CLPV_X_BINS; ++b) {
    const SweepTile columns = clpv_transpose(tiles[b]);
    for (int r = 0; r < CLPV_LANES; ++r) {
      if (x + r >= CLPV_GRID) break;
      const int at = b * CLPV_SWEEP_VOLUME + clpv_sweep_at(x + r, z, y);
      CLPV_SWEEP_STORE(sources, at, CLPV_SWEEP_LOAD(sources, at) + columns.row[r]);
    }
  }
}

CLPV_INLINE void clpv_set_tile_row(const Bins bins, const int r, SweepTile* tiles) {
#define CLPV_DO(b) tiles[b].row[r] = bins.c##b;
  CLPV_EACH_X_BIN(CLPV_DO)
#undef CLPV_DO
}

// Declares the tile's first cell (x, y, z), its channel, and the index `first` of the channel's volumes.
#define CLPV_THIS_TILE                                                                          \
  const int x = CLPV_LANES * (int)get_global_id(0), y = CLPV_LANES * (int)get_global_id(1);     \
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID; \
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;                                                 \
  const int first = channel * CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME;

// Adds to `sources` the light of `flux`, an expression for the flux that leaves the cells in row r. Overwrites `tiles`.
#define CLPV_INJECT(flux)                                \
  for (int r = 0; r < CLPV_LANES; ++r) {                 \
    Bins bins = clpv_zero_bins();                        \
    if (y + r < CLPV_GRID) {                             \
      bins = clpv_reflected_intensity(flux);                  \
      clpv_add_row(bins, sources + first, x, y + r, z);  \
    }                                                    \
    clpv_set_tile_row(bins, r, tiles);                   \
  }                                                      \
  clpv_add_x_bins(tiles, sources + first, x, y, z);

// Incident flux on the cells in row r of tiles of `volumes`.
#define CLPV_INCIDENT_FLUX(volumes, tiles) clpv_incident_flux(clpv_load_bins(volumes, tiles, r, x, y + r, z))

__kernel void inject_reflected(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors, CLPV_BUFFER_OUT sources) {
  CLPV_THIS_TILE
  if (!clpv_tile_reflects(reflectors, channel, x, y, z)) return;
  SweepTile tiles[CLPV_X_BINS];
  clpv_load_x_bins(swept + first, x, y, z, tiles);
  CLPV_INJECT(clpv_reflected_flux(CLPV_INCIDENT_FLUX(swept + first, tiles),
                                  light_load(reflectors, channel, x, y + r, z)))
}

__kernel void inject_series(CLPV_BUFFER_IN first_swept, CLPV_BUFFER_IN second_swept, CLPV_VOLUME_IN reflectors,
                            CLPV_VOLUME_IN series, CLPV_BUFFER_OUT sources) {
  CLPV_THIS_TILE
  if (!clpv_tile_reflects(reflectors, channel, x, y, z)) return;
  SweepTile tiles[CLPV_X_BINS], second[CLPV_X_BINS];
  clpv_load_x_bins(first_swept + first, x, y, z, tiles);
  clpv_load_x_bins(second_swept + first, x, y, z, second);
  CLPV_INJECT(clpv_add(clpv_reflected_flux(CLPV_INCIDENT_FLUX(first_swept + first, tiles),
                                           light_load(reflectors, channel, x, y + r, z)),
                       clpv_reflected_flux(CLPV_INCIDENT_FLUX(second_swept + first, second),
                                           light_load(series, channel, x, y + r, z))))
}

__kernel void inject_unit(CLPV_VOLUME_IN series, CLPV_BUFFER_OUT sources) {
  CLPV_THIS_TILE
  if (!clpv_tile_reflects(series, channel, x, y, z)) return;
  SweepTile tiles[CLPV_X_BINS];
  CLPV_INJECT(light_load(series, channel, x, y + r, z))
}

__kernel void extend_series(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors, CLPV_VOLUME_OUT series) {
  CLPV_THIS_TILE
  SweepTile tiles[CLPV_X_BINS];
  clpv_load_x_bins(swept + first, x, y, z, tiles);
  for (int r = 0; r < CLPV_LANES; ++r) {
    if (y + r >= CLPV_GRID) break;
    const Coefficients returned = CLPV_INCIDENT_FLUX(swept + first, tiles);
    light_store(series, channel, x, y + r, z, clpv_series(returned, light_load(reflectors, channel, x, y + r, z)));
  }
}

// Incident flux on one face of a row of finer cells from (x, y, z) on, from the coarser cells' faces: trilinear, and a
// quarter, since a finer face has a quarter of the area.
CLPV_INLINE CLPV_REAL clpv_interpolate(CLPV_BUFFER_IN incident, const int x, const int y, const int z) {
  CLPV_BUFFER_IN from = incident + clpv_bordered_at(CLPV_LOWER(z), CLPV_LOWER(y), CLPV_LOWER(x));
  const float tz = CLPV_UPPER_WEIGHT(z), ty = CLPV_UPPER_WEIGHT(y);
#define CLPV_BILINEAR(at)                                                                                          \
  ((1.0f - tz) * ((1.0f - ty) * CLPV_SWEEP_LOAD(from, at) + ty * CLPV_SWEEP_LOAD(from, (at) + CLPV_SWEEP_PITCH)) + \
   tz * ((1.0f - ty) * CLPV_SWEEP_LOAD(from, (at) + CLPV_BORDERED_PLANE) +                                         \
         ty * CLPV_SWEEP_LOAD(from, (at) + CLPV_BORDERED_PLANE + CLPV_SWEEP_PITCH)))
  const CLPV_REAL v = CLPV_BILINEAR(0);
#if CLPV_LANES == 8
  return 0.25f * (x & 1 ? CLPV_ODD(v) : CLPV_EVEN(v));
#else
  const float tx = CLPV_UPPER_WEIGHT(x);
  return 0.25f * ((1.0f - tx) * v + tx * CLPV_BILINEAR(1));
#endif
}

CLPV_INLINE Coefficients clpv_interpolate_faces(CLPV_BUFFER_IN incident, const int x, const int y, const int z) {
  Coefficients flux;
#define CLPV_DO(i) flux.c##i = clpv_interpolate(incident + i * CLPV_BORDERED_VOLUME, x, y, z);
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return flux;
}

// dx, dy, dz: offset of the grid's origin from the coarser one's, in finer cells (coarse_to_fine.h).
__kernel void inject_interpolated(CLPV_BUFFER_IN incident, const int dx, const int dy, const int dz,
                                  CLPV_VOLUME_IN reflectors, CLPV_BUFFER_OUT sources) {
  CLPV_THIS_TILE
  if (!clpv_tile_reflects(reflectors, channel, x, y, z)) return;
  CLPV_BUFFER_IN faces = incident + channel * CLPV_N * CLPV_BORDERED_VOLUME;
  SweepTile tiles[CLPV_X_BINS];
  CLPV_INJECT(clpv_reflected_flux(clpv_interpolate_faces(faces, x + dx, y + r + dy, z + dz),
                                  light_load(reflectors, channel, x, y + r, z)))
}
