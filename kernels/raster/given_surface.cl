// SPDX-License-Identifier: MIT
// Takes a G-buffer that a caller made, as a surface (surface_row.h).
//
// In:   given_places, given_normals   depths [m], or with CLPV_POINTS positions [m] (w unused);
//                                     normals of any length (w unused)
// Out:  places, normals               positions have w = 1; normals are unit vectors
// A pixel has no surface, and depth or w 0, if its depth is not positive, if its normal is 0, or if
// any of its numbers is not finite. Normals whose length is 1 up to rounding are copied. A
// work-item takes one of `count` pixels.
#include "raster/surface_row.h"

// Largest difference of a unit normal's square from 1.
__constant const float unit_rounding = 1e-5f;

static inline bool is_finite(const float v) {
  return fabs(v) < INFINITY;  // false for NaN
}

// Unit vector along n; 0 if n is 0 or not finite.
CLPV_INLINE float4 unit_normal(const float4 n) {
  const float4 none = (float4)(0.0f, 0.0f, 0.0f, 0.0f);
  if (!(is_finite(n.x) && is_finite(n.y) && is_finite(n.z))) return none;
  const float most = fmax(fmax(fabs(n.x), fabs(n.y)), fabs(n.z));
  if (!(most > 0.0f)) return none;
  const float square = n.x * n.x + n.y * n.y + n.z * n.z;
  if (fabs(square - 1.0f) < unit_rounding) return (float4)(n.x, n.y, n.z, 0.0f);
  const float x = n.x / most, y = n.y / most, z = n.z / most, scale = rsqrt(x * x + y * y + z * z);
  return (float4)(scale * x, scale * y, scale * z, 0.0f);
}

__kernel void given_surface(const uint count, __global const Place* given_places,
                            __global const float4* given_normals, __global Place* places,
                            __global float4* normals) {
  const uint i = get_global_id(0);
  if (i >= count) return;
  const Place place = given_places[i];
  const float4 normal = unit_normal(given_normals[i]);
  const bool has_normal = normal.x != 0.0f || normal.y != 0.0f || normal.z != 0.0f;
#if CLPV_POINTS
  const bool seen = has_normal && is_finite(place.x) && is_finite(place.y) && is_finite(place.z);
  places[i] = seen ? (float4)(place.x, place.y, place.z, 1.0f) : (float4)(0.0f, 0.0f, 0.0f, 0.0f);
#else
  const bool seen = has_normal && is_finite(place) && place > 0.0f;
  places[i] = seen ? place : 0.0f;
#endif
  normals[i] = seen ? normal : (float4)(0.0f, 0.0f, 0.0f, 0.0f);
}
