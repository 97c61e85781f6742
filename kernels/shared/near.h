// SPDX-License-Identifier: MIT
// Layout of the near field's buffers (near_layout.h), shared by host and kernels.
#pragma once

#define CLPV_NEAR_TILE 4     // pixels along each side of a square, each of which has its own directions
#define CLPV_NEAR_COLUMNS 8  // empty columns before and at least as many after each row, for the filter's window
#define CLPV_NEAR_ROWS 3     // empty rows above and below

// First row of the second layer (near_points.cl); at least CLPV_NEAR_ROWS empty rows lie before it.
#define CLPV_NEAR_SECOND_OF(height) (((height) + CLPV_NEAR_ROWS + CLPV_NEAR_TILE - 1) / CLPV_NEAR_TILE * CLPV_NEAR_TILE)

// Planes of points, one number per pixel: position [m], normal, and reach R [m], 0 without a surface in a cascade.
enum {
  CLPV_NEAR_POSITION = 0,
  CLPV_NEAR_NORMAL = 3,
  CLPV_NEAR_REACH = 6,
  CLPV_NEAR_PLANES = 7,
};

// Planes of light, one number per pixel and channel: D and the gathered irradiance [W/m^2].
enum {
  CLPV_NEAR_DIFFERENCE = 0,
  CLPV_NEAR_GATHERED = 3,
  CLPV_NEAR_LIGHT_PLANES = 6,
};

// Numbers of a row and of a plane of `width` x `height` pixels, the rows of both layers.
#define CLPV_NEAR_PITCH_OF(width) (((width) + 7) / 8 * 8 + 2 * CLPV_NEAR_COLUMNS)
#define CLPV_NEAR_PLANE_OF(width, height) (CLPV_NEAR_PITCH_OF(width) * ((height) + 2 * CLPV_NEAR_ROWS))

// Rows of eight hits: weights of the triangle's second and third vertex, distance [m], the triangle (uint), its pixel in a
// plane (uint), and the ray's place among the radiances (uint).
enum {
  CLPV_HIT_U,
  CLPV_HIT_V,
  CLPV_HIT_DISTANCE,
  CLPV_HIT_TRIANGLE,
  CLPV_HIT_PIXEL,
  CLPV_HIT_RADIANCE,
  CLPV_HIT_ROWS,
};

// Distance of a ray's origin from its surface [R].
#define CLPV_NEAR_LIFT 1e-3f
