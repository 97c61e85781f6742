// SPDX-License-Identifier: MIT
// Bins, directions and halo of a sweep, and the sizes of its buffers (host/basis/sweep.hpp), shared
// by host and kernels.
#pragma once

enum {
  CLPV_SWEEP_BINS = 24,
  CLPV_AXIS_BINS = 8,  // bins swept across x, which come first; as many across y, then z
  CLPV_HIDDEN_WORDS = 9,  // of seen_points.cl per cube: a byte for each of 28 pairs, 8 centres
};

// A bin of directions. Light travels from plane to plane, within a plane from row to row, and
// within a row from column to column.
typedef struct {
  // 1: light travels towards larger numbers; -1: towards smaller ones.
  int plane_sign, row_sign, column_sign;
  int plane_axis, row_axis, column_axis;  // 0 x, 1 y, 2 z
  int links[4];  // transmittance volumes of the links from the cells offset by 0, u, v, and u and v
  int transposed;  // 1: sources are in the volumes across x; 0: in those across z (sweep_source.cl)
  int plane, row;  // index steps in `sources` to the next plane and to the next row
} ClpvSweepBin;

typedef struct {
  float taps[4];       // t_k of the four cells of ClpvSweepBin::links; their sum is 1
  float share;  // Omega_d / (|w_m| Omega_b): solid angles of direction and bin, component across
                // planes
  float from_coarser;  // D in this cascade / D in the coarser one
  int coarser;         // part of the bin that contains this direction in the coarser cascade
  float attenuation[3];  // exp(-sigma_t s / |w_m|) of a medium, by channel; 1 without one
  float cosine;          // |w_m|
  int unused;
} ClpvSweepDirection;

// Halo: cells of a coarser cascade that the border of the next finer one interpolates.
typedef struct {
  int first[3];   // lowest cell of the box that holds them
  int side;       // cells along each edge of the box; 0: no finer cascade
  int layers[6];  // index of the lower of two layers, two per axis (x, y, z): for light towards
                  // larger, then towards smaller numbers
} ClpvSweepHalo;

// Sizes in numbers for a grid of n cells along each axis: of a row, a plane and a volume of planes
// (sweep_layout.h), and of a row (pitch), a plane and a volume with a border of one cell on every
// side.
enum {
  CLPV_SWEEP_LINE = 32,  // padding after each plane and each volume
  CLPV_SWEEP_FIRST =
      8,  // from the start of a bordered row to its first cell: aligned for eight lanes
};
static inline int sweep_row_size(const int n) { return (n + 7) / 8 * 8; }
static inline int sweep_plane_size(const int n) { return n * sweep_row_size(n) + CLPV_SWEEP_LINE; }
static inline int sweep_volume_size(const int n) {
  return n * sweep_plane_size(n) + CLPV_SWEEP_LINE;
}
static inline int bordered_pitch(const int n) { return sweep_row_size(n) + CLPV_SWEEP_FIRST; }
static inline int bordered_plane_size(const int n) {
  return (n + 2) * bordered_pitch(n) + CLPV_SWEEP_FIRST;
}
static inline int bordered_volume_size(const int n) { return (n + 2) * bordered_plane_size(n); }

// Sizes of a halo: cells along an edge; numbers of a row and of a face, which has two layers of
// side x side cells. Loads of eight may read past the end of a row, hence the padding.
static inline int halo_side(const int n) { return (n + 1) / 2 + 3; }
static inline int halo_pitch(const int side) { return (side + 7) / 8 * 8 + 8; }
static inline int halo_face_size(const int side) { return 2 * side * halo_pitch(side) + 8; }
