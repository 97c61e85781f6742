// SPDX-License-Identifier: MIT
// Layout of the near field's buffers (near_layout.h), shared by host and kernels.
#pragma once

// Planes of points, one number per pixel: position [m], normal, reach R [m] (0: no surface inside a
// cascade), and the encoded geometric normal (normal.h).
enum {
  CLPV_NEAR_POSITION = 0,
  CLPV_NEAR_NORMAL = 3,
  CLPV_NEAR_REACH = 6,
  CLPV_NEAR_GEOMETRIC = 7,
  CLPV_NEAR_PLANES = 8,
};

// Planes of light, one number per pixel and channel: D and the gathered irradiance [W/m^2].
enum {
  CLPV_NEAR_DIFFERENCE = 0,
  CLPV_NEAR_GATHERED = 3,
  CLPV_NEAR_LIGHT_PLANES = 6,
};

// Rows of W hits: weights of the triangle's second and third vertex, distance [m], the triangle
// (uint), its pixel in a plane (uint), and the ray's place among the radiances (uint).
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
