// SPDX-License-Identifier: MIT
// Per-face sums of voxelised albedo: reflectors.cl writes them, face_albedo.cl reads them; shared
// by host and kernels.
#pragma once

// Face directions of a light cell: +x, -x, +y, -y, +z, -z. uint32 words of a face: 64 coverage bits
// (two words), the number of samples, and the sums of red, green and blue albedo and of shares, all
// weighted by shares (reflectors.cl).
enum {
  CLPV_CELL_FACES = 6,
  CLPV_FACE_WORDS = 7,
  CLPV_FACE_SAMPLES = 2,
  CLPV_FACE_ALBEDO = 3,
  CLPV_FACE_SHARE = 6,
};

// Channels of reflectors after red, green and blue (face_albedo.cl).
enum {
  CLPV_REFLECTOR_SHARE = 3,
  CLPV_REFLECTOR_WHITE = 4,
  CLPV_REFLECTOR_AREA = 5,
  CLPV_REFLECTOR_CHANNELS = 6,
};

// Least tilt 1 / m - 1 of triangles against the grid that is no rounding of their share m
// (sweep/bounce.cl).
#define CLPV_LEAST_TILT 2e-3f

// Channels of the series S of all bounces: red, green, blue; then those of E, which reflects the
// first light (sweep/bounce.cl).
enum { CLPV_SERIES_FIRST = 3, CLPV_SERIES_CHANNELS = 6 };

// Fixed-point value of albedo 1 in those sums. 2^14 triangles that each cover the whole face fit
// into 32 bits.
#define CLPV_ALBEDO_UNIT 4096.0f
