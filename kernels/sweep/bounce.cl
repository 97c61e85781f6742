// SPDX-License-Identifier: MIT
// Reflects swept light off the surfaces in a cascade's cells: one more bounce, or all bounces as a
// truncated Neumann series.
//
//   I' = I + R D                     inject_reflected   one more bounce
//   I' = I + E D                     inject_reflected   the first of all bounces
//   I' = I + R D_1 + S (D_2 - D_1)   inject_series      all bounces; D_2: of one sweep more
//   S = R + T_1 + T_2 / (1 - q),  E = R / (1 - 2 q / 3),  T_k = R X_k
//                             reflect_returned   T_1
//                             sum_series         S, E
//   R = R_0 pi / F              normalise_reflectors   F: incident flux of a white furnace
//
// docs/method.md, 'More bounces'. D [W] is the incident flux on a face, R in [0, 1] the reflectance
// of a face per channel, I the injected light, I' the sources of the next sweep. X_k is the flux
// that comes back to a face after k reflections elsewhere, per 1 W that left it. By reciprocity X_1
// is the incident flux while every face emits R, X_2 while it emits T_1 (inject_flux). q in [0, the
// cell's largest albedo] is T_2 / T_1. S and E depend on the surfaces, not on light. A face of
// normal a that receives D_a emits, projected on the basis,
//   I(w) = Phi_a max(0, w.a) / pi,   Phi_a = R_a D_a
// D_a is the flux about the normal n_a of the face's triangles, else they would receive what they
// emit (face_normal):
//   n_a = (1 - t) a + t v, normalised      t = min(1, (1 / m_a - 1) / (|v|_1 - 1))
//   v = V / |V|, V = W_a a + sum_c min(1, (1 / m_c - 1) / (1 / m_a - 1)) W_c c
// c: the four faces across a; W: R_0 of albedo 1, the same in each use of a face.
// With CLPV_BANDED, light of all bands but the first is divided by the share m_a of the face's
// triangles: |n_a| = m_a (|n_x| + |n_y| + |n_z|), so that the faces of a surface emit the clamped
// cosine about its normal n in bands 0 and 1.
//
// In:   swept             L s^2 [W/sr] of 3 channels and 24 bins (sweep_layout.h)
//       reflectors, series  R; S and, from channel CLPV_SERIES_FIRST on, E: volumes of six numbers
//                           per cell and channel, faces as in shared/reflectors.h; further
//                           channels of R: face_albedo.cl
//       injected          I: light volume [W/sr]
// Out:  sources, lit      I' as the next sweep injects it (sources.h)
// From the host (host/pipeline/sweep/sweep_literals.cpp): CLPV_LOBES, the lobe of 1 W about each
// face's normal, CLPV_MAX_RETURNED, the largest q, CLPV_RELAXATION, the 2 / 3 of E, CLPV_INCIDENT,
// the weights of D_a for each face and bin.
// A work-item computes a tile of W x W cells of a slice, of one channel or for the sources of all.
#include "vec.h"
#include "volume/coefficients.h"
#include "shared/reflectors.h"
#include "sweep/sources.h"
#include "sweep/sweep_tiles.h"
#include "volume/light.h"

// Numbers of a channel in swept light.
#define CLPV_CHANNEL_BINS (CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME)

// Tiles of the bins of a channel that are swept across x.
typedef struct {
  SweepTile bin[CLPV_AXIS_BINS];
} XBins;

// Numbers of the six faces of W cells, in the order of shared/reflectors.h.
typedef struct {
  realW c[CLPV_CELL_FACES];
} FaceFluxes;

__constant const float incident_weights[CLPV_CELL_FACES][CLPV_SWEEP_BINS] = CLPV_INCIDENT;

// Flux [W] on each face, pi of even light 1, of triangles along the grid:
//
//   D_a = 0.956 sum_b Omega_b max(0, -w_b.a) L_b s^2
CLPV_INLINE FaceFluxes flux_along_grid(const Bins bins) {
  FaceFluxes flux;
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a) {
    flux.c[a] = 0.0f;
#pragma unroll
    for (int b = 0; b < CLPV_SWEEP_BINS; ++b)
      if (incident_weights[a][b] != 0.0f)
        flux.c[a] = fma((realW)(incident_weights[a][b]), bins.c[b], flux.c[a]);
  }
  return flux;
}

// The same of `channels` with the normal n in place of a.
CLPV_INLINE void flux_about(const Vec n, const Bins* bins, const int channels, realW* flux) {
  for (int c = 0; c < channels; ++c) flux[c] = ZERO;
#pragma unroll
  for (int b = 0; b < CLPV_SWEEP_BINS; ++b) {
    const realW x = (realW)(incident_weights[0][b] - incident_weights[1][b]),
                y = (realW)(incident_weights[2][b] - incident_weights[3][b]),
                z = (realW)(incident_weights[4][b] - incident_weights[5][b]),
                cosine = fmax(fma(n.x, x, fma(n.y, y, n.z * z)), ZERO);
    for (int c = 0; c < channels; ++c) flux[c] = fma(cosine, bins[c].c[b], flux[c]);
  }
}

// Tilts 1 / m - 1 of the faces' triangles against the grid; 0 along it, and on faces without one.
CLPV_INLINE FaceFluxes find_tilts(const FaceFluxes share) {
  FaceFluxes tilt;
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a) {
    const realW t = 1.0f / share.c[a] - 1.0f;
    tilt.c[a] = ((share.c[a] > ZERO) & (t > (realW)(CLPV_LEAST_TILT))) ? t : ZERO;
  }
  return tilt;
}

// Part of the surface of face a, of tilt t, that lies on the faces +b and -b: their difference.
CLPV_INLINE realW across(const FaceFluxes area, const FaceFluxes tilt, const realW per_tilt,
                         const int b) {
  return area.c[2 * b] * fmin(tilt.c[2 * b] * per_tilt, ONE) -
         area.c[2 * b + 1] * fmin(tilt.c[2 * b + 1] * per_tilt, ONE);
}

// Normal of the triangles of face a: a along the grid, else towards the vector area v of those that
// are tilted as much.
CLPV_INLINE Vec face_normal(const FaceFluxes area, const FaceFluxes tilt, const int a) {
  const int axis = a / 2, b = (axis + 1) % 3, c = (axis + 2) % 3;
  const realW t = tilt.c[a], per_tilt = t > ZERO ? 1.0f / t : ZERO;
  const realW v_a = fmax(area.c[a], (realW)(1e-6f)), v_b = across(area, tilt, per_tilt, b),
              v_c = across(area, tilt, per_tilt, c);
  const realW per_length = rsqrt(v_a * v_a + v_b * v_b + v_c * v_c),
              sides = per_length * (v_a + fabs(v_b) + fabs(v_c)) - 1.0f,
              part = t < sides ? t / sides : ONE;
  const realW n_a = 1.0f - part + part * per_length * v_a, n_b = part * per_length * v_b,
              n_c = part * per_length * v_c, unit = rsqrt(n_a * n_a + n_b * n_b + n_c * n_c);
  realW n[3];
  n[axis] = (a % 2 == 0 ? unit : -unit) * n_a;
  n[b] = unit * n_b;
  n[c] = unit * n_c;
  return vec(n[0], n[1], n[2]);
}

// Fluxes of `channels` on the faces: about the normals of their triangles, which do not receive
// what leaves them.
CLPV_INLINE void incident_fluxes(const Bins* bins, const int channels, const FaceFluxes share,
                                 const FaceFluxes area, FaceFluxes* fluxes) {
  const FaceFluxes tilt = find_tilts(share);
  realW most = ZERO;
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a) most = fmax(most, tilt.c[a]);
  if (no_lane(most > ZERO)) {
    for (int c = 0; c < channels; ++c) fluxes[c] = flux_along_grid(bins[c]);
    return;
  }
#pragma unroll 1
  for (int a = 0; a < CLPV_CELL_FACES; ++a) {
    realW flux[3];
    flux_about(face_normal(area, tilt, a), bins, channels, flux);
    for (int c = 0; c < channels; ++c) fluxes[c].c[a] = flux[c];
  }
}

#define CLPV_VOLUME faces
#define CLPV_VOLUME_N CLPV_GRID
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

// R D_1 + S (D_2 - D_1), not below 0.
CLPV_INLINE FaceFluxes series_flux(const FaceFluxes before, const FaceFluxes after,
                                   const FaceFluxes reflectance, const FaceFluxes series) {
  FaceFluxes flux;
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a)
    flux.c[a] = fmax(fma(series.c[a], after.c[a] - before.c[a], reflectance.c[a] * before.c[a]),
                     ZERO);
  return flux;
}

// The ratio q = T_2 / T_1 of each face; the largest albedo bounds it. `white`: R of albedo 1.
CLPV_INLINE FaceFluxes find_ratios(const FaceFluxes first, const FaceFluxes second,
                                   const FaceFluxes reflectance, const FaceFluxes white) {
  realW largest = 0.0f;
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a)
    largest = fmax(largest, reflectance.c[a] / fmax(white.c[a], 1e-6f));
  largest = fmin(largest, CLPV_MAX_RETURNED);
  FaceFluxes ratio;
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a)
    ratio.c[a] = fmin(fmax(second.c[a] / fmax(first.c[a], 1e-6f), ZERO), largest);
  return ratio;
}

// Sum of the geometric series of a flux: flux / (1 - ratio).
CLPV_INLINE FaceFluxes sum_series_of(const FaceFluxes flux, const FaceFluxes ratio,
                                     const float share) {
  FaceFluxes sum;
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a)
    sum.c[a] = flux.c[a] / (1.0f - share * ratio.c[a]);
  return sum;
}

// Intensity [W/sr] of light that leaves each face as a lobe. `share`: m.
CLPV_INLINE Coefficients reflected_intensity(const FaceFluxes flux, const FaceFluxes share) {
  Coefficients c = zero_coefficients();
#pragma unroll
  for (int a = 0; a < CLPV_CELL_FACES; ++a) {
    const realW per_share =
        CLPV_BANDED ? flux.c[a] / fmax(share.c[a], (realW)(CLPV_LEAST_SHARE)) : flux.c[a];
    c.c[0] = fma((realW)(lobes[a][0]), flux.c[a], c.c[0]);
#pragma unroll
    for (int i = 1; i < CLPV_N; ++i)
      if (lobes[a][i] != 0.0f) c.c[i] = fma((realW)(lobes[a][i]), per_share, c.c[i]);
  }
  return c;
}

// Tile of a work-item: its first cell, its channel, and the index `first` of the channel's bins.
typedef struct {
  int x, y, z, channel, first;
  int rows;  // inside the grid; 0: the tile is outside
} Tile;

CLPV_INLINE Tile find_tile(const int channel) {
  Tile t;
  t.x = W * (int)get_global_id(0), t.y = W * (int)get_global_id(1);
  t.z = (int)get_global_id(2) % CLPV_GRID, t.channel = channel;
  t.first = t.channel * CLPV_CHANNEL_BINS;
  t.rows = t.x < CLPV_GRID ? clamp(CLPV_GRID - t.y, 0, W) : 0;
  return t;
}

// Channel of a work-item that has one.
CLPV_INLINE int own_channel(void) { return (int)get_global_id(2) / CLPV_GRID; }

// Incident fluxes of `channels`, from the tile's own on, on the cells in row r of a tile of swept
// light.
CLPV_INLINE void load_incident_fluxes(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors,
                                      const XBins* x_bins, const int channels, const Tile t,
                                      const int r, FaceFluxes* fluxes) {
  Bins bins[3];
  for (int c = 0; c < channels; ++c)
    bins[c] = load_bins(swept + t.first + c * CLPV_CHANNEL_BINS, x_bins[c].bin, r, t.x, t.y + r,
                        t.z);
  incident_fluxes(bins, channels, faces_load(reflectors, CLPV_REFLECTOR_SHARE, t.x, t.y + r, t.z),
                  faces_load(reflectors, CLPV_REFLECTOR_AREA, t.x, t.y + r, t.z), fluxes);
}

// The same of one channel.
CLPV_INLINE FaceFluxes load_incident_flux(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors,
                                          const XBins* x_bins, const Tile t, const int r) {
  FaceFluxes flux;
  load_incident_fluxes(swept, reflectors, x_bins, 1, t, r, &flux);
  return flux;
}

// Light that leaves the faces of the cells in row r of a tile.
CLPV_INLINE Coefficients row_light(const FaceFluxes flux, CLPV_VOLUME_IN reflectors, const Tile t,
                                   const int r) {
  return reflected_intensity(flux, faces_load(reflectors, CLPV_REFLECTOR_SHARE, t.x, t.y + r, t.z));
}

// Bit r: the cells in row r of a tile hold surfaces.
CLPV_INLINE uint rows_with_surfaces(CLPV_VOLUME_IN reflectors, const Tile t) {
  uint rows = 0;
  for (int r = 0; r < t.rows; ++r) {
    const FaceFluxes share = faces_load(reflectors, CLPV_REFLECTOR_SHARE, t.x, t.y + r, t.z);
    realW sum = ZERO;
#pragma unroll
    for (int a = 0; a < CLPV_CELL_FACES; ++a) sum += share.c[a];
    rows |= no_lane(sum > ZERO) ? 0 : 1u << r;
  }
  return rows;
}

CLPV_INLINE void load_all_x_bins(CLPV_BUFFER_IN swept, const Tile t, XBins* x_bins) {
  for (int c = 0; c < 3; ++c)
    load_x_bins(swept + c * CLPV_CHANNEL_BINS, t.x, t.y, t.z, x_bins[c].bin);
}

// `reflectance`: R or, from channel `first` on, E.
__kernel void inject_reflected(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors,
                               CLPV_VOLUME_IN reflectance, const int first,
                               CLPV_VOLUME_IN injected, CLPV_BUFFER_OUT sources,
                               __global uchar* lit) {
  TileLight light = dark_light();
  const Tile t = find_tile(0);
  const uint rows = rows_with_surfaces(reflectors, t);
  XBins bins[3];
  if (rows != 0) load_all_x_bins(swept, t, bins);
  for (int r = 0; r < t.rows; ++r) {
    FaceFluxes incident[3];
    const bool reflects = rows >> r & 1;
    if (reflects) load_incident_fluxes(swept, reflectors, bins, 3, t, r, incident);
    for (int channel = 0; channel < 3; ++channel) {
      Coefficients c = light_load(injected, channel, t.x, t.y + r, t.z);
      if (reflects) {
        const FaceFluxes flux = reflect_flux(
            incident[channel], faces_load(reflectance, first + channel, t.x, t.y + r, t.z));
        c = add_coefficients(row_light(flux, reflectors, t, r), c);
      }
      set_light(&light, channel, r, c);
    }
  }
  write_sources(&light, sources, lit);
}

__kernel void inject_series(CLPV_BUFFER_IN first_swept, CLPV_BUFFER_IN second_swept,
                            CLPV_VOLUME_IN reflectors, CLPV_VOLUME_IN series,
                            CLPV_VOLUME_IN injected, CLPV_BUFFER_OUT sources,
                            __global uchar* lit) {
  TileLight light = dark_light();
  const Tile t = find_tile(0);
  const uint rows = rows_with_surfaces(reflectors, t);
  XBins first[3], second[3];
  if (rows != 0) {
    load_all_x_bins(first_swept, t, first);
    load_all_x_bins(second_swept, t, second);
  }
  for (int r = 0; r < t.rows; ++r) {
    FaceFluxes before[3], after[3];
    const bool reflects = rows >> r & 1;
    if (reflects) {
      load_incident_fluxes(first_swept, reflectors, first, 3, t, r, before);
      load_incident_fluxes(second_swept, reflectors, second, 3, t, r, after);
    }
    for (int channel = 0; channel < 3; ++channel) {
      Coefficients c = light_load(injected, channel, t.x, t.y + r, t.z);
      if (reflects) {
        const FaceFluxes flux = series_flux(before[channel], after[channel],
                                            faces_load(reflectors, channel, t.x, t.y + r, t.z),
                                            faces_load(series, channel, t.x, t.y + r, t.z));
        c = add_coefficients(c, row_light(flux, reflectors, t, r));
      }
      set_light(&light, channel, r, c);
    }
  }
  write_sources(&light, sources, lit);
}

// Every face emits the channels from `first` on of `flux` times `factor`; with `step` 0 all
// channels emit the first.
__kernel void inject_flux(CLPV_VOLUME_IN flux, CLPV_VOLUME_IN reflectors, const int first,
                          const int step, const float factor, CLPV_BUFFER_OUT sources,
                          __global uchar* lit) {
  TileLight light = dark_light();
  const Tile t = find_tile(0);
  for (int channel = 0; channel < 3; ++channel) {
    for (int r = 0; r < t.rows; ++r) {
      const FaceFluxes emitted = faces_load(flux, first + step * channel, t.x, t.y + r, t.z);
      set_light(&light, channel, r,
                scale_coefficients(factor, row_light(emitted, reflectors, t, r)));
    }
  }
  write_sources(&light, sources, lit);
}

// As furnace_divisor() of gather/gather_packed.h.
CLPV_INLINE realW furnace_divisor(const realW f) {
  const realW rest = 1.0f - (1.0f / CLPV_LEAST_WHITE - 1.0f) * fmax(f, ZERO);
  return f >= (realW)(CLPV_LEAST_WHITE) ? f : rest;
}

// `swept`: a white furnace in channel 0; `white`: the F of a face that it lights fully. Also
// divides R of albedo 1, so that R over it stays the albedo.
__kernel void normalise_reflectors(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors,
                                   const float white, CLPV_VOLUME_OUT normalised) {
  Tile t = find_tile(own_channel());
  if (t.rows == 0) return;
  const bool divided = t.channel != CLPV_REFLECTOR_SHARE && t.channel != CLPV_REFLECTOR_AREA;
  t.first = 0;
  XBins bins;
  load_x_bins(swept, t.x, t.y, t.z, bins.bin);
  for (int r = 0; r < t.rows; ++r) {
    FaceFluxes faces = faces_load(reflectors, t.channel, t.x, t.y + r, t.z);
    const FaceFluxes furnace = load_incident_flux(swept, reflectors, &bins, t, r);
#pragma unroll
    for (int a = 0; a < CLPV_CELL_FACES && divided; ++a)
      faces.c[a] = faces.c[a] / furnace_divisor(furnace.c[a] * (1.0f / white));
    faces_store(normalised, t.channel, t.x, t.y + r, t.z, faces);
  }
}

__kernel void reflect_returned(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors,
                               CLPV_VOLUME_OUT returned) {
  const Tile t = find_tile(own_channel());
  if (t.rows == 0) return;
  XBins bins;
  load_x_bins(swept + t.first, t.x, t.y, t.z, bins.bin);
  for (int r = 0; r < t.rows; ++r)
    faces_store(returned, t.channel, t.x, t.y + r, t.z,
                reflect_flux(load_incident_flux(swept, reflectors, &bins, t, r),
                             faces_load(reflectors, t.channel, t.x, t.y + r, t.z)));
}

__kernel void sum_series(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors, CLPV_VOLUME_IN returned,
                         CLPV_VOLUME_OUT series) {
  const Tile t = find_tile(own_channel());
  if (t.rows == 0) return;
  XBins bins;
  load_x_bins(swept + t.first, t.x, t.y, t.z, bins.bin);
  for (int r = 0; r < t.rows; ++r) {
    const FaceFluxes reflectance = faces_load(reflectors, t.channel, t.x, t.y + r, t.z),
                     first = faces_load(returned, t.channel, t.x, t.y + r, t.z),
                     incident = load_incident_flux(swept, reflectors, &bins, t, r),
                     second = reflect_flux(incident, reflectance),
                     white = faces_load(reflectors, CLPV_REFLECTOR_WHITE, t.x, t.y + r, t.z),
                     ratio = find_ratios(first, second, reflectance, white);
    faces_store(series, t.channel, t.x, t.y + r, t.z,
                add_fluxes(reflectance, add_fluxes(first, sum_series_of(second, ratio, 1.0f))));
    faces_store(series, CLPV_SERIES_FIRST + t.channel, t.x, t.y + r, t.z,
                sum_series_of(reflectance, ratio, CLPV_RELAXATION));
  }
}
