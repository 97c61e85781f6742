// SPDX-License-Identifier: MIT
// Stored geometric normals of W pixels (shared/normal.h).
#pragma once

#include "lanes.h"
#include "shared/normal.h"
#include "vec.h"

// Folds the lower half of the octahedron over the upper one, and back.
static inline realW fold_octahedron(const realW along, const realW other) {
  const realW folded = 1.0f - fabs(other);
  return along < ZERO ? -folded : folded;
}

// Encodes `geometric` as a whole number (shared/normal.h); 0 where it equals `shading`.
CLPV_INLINE realW pack_geometric_normal(const Vec geometric, const Vec shading) {
  const Vec g = geometric;
  const realW scale = 1.0f / (fabs(g.x) + fabs(g.y) + fabs(g.z)), x = g.x * scale, y = g.y * scale;
  const realW u = g.z < ZERO ? fold_octahedron(x, y) : x,
              v = g.z < ZERO ? fold_octahedron(y, x) : y;
  const realW column = to_realW(to_intW_rte(u * CLPV_NORMAL_STEPS)) + CLPV_NORMAL_ZERO,
              row = to_realW(to_intW_rte(v * CLPV_NORMAL_STEPS)) + CLPV_NORMAL_ZERO;
  return vec_dot(geometric, shading) > (realW)(CLPV_SAME_NORMAL) ? ZERO
                                                                 : column + CLPV_NORMAL_BASE * row;
}

// Normals along which lookups in volumes and origins of rays are lifted.
CLPV_INLINE Vec lift_normal(const Vec geometric, const Vec shading) {
  const intW apart = vec_dot(geometric, shading) <= (realW)(CLPV_SAME_LIFT);
  return (Vec){apart ? geometric.x : shading.x, apart ? geometric.y : shading.y,
               apart ? geometric.z : shading.z};
}

// Geometric normals, of length 1, of pixels with these numbers and shading normals.
CLPV_INLINE Vec unpack_geometric_normal(const realW number, const Vec shading) {
  const realW row = to_realW(to_intW(number * (1.0f / CLPV_NORMAL_BASE)));
  const realW u = (number - CLPV_NORMAL_BASE * row - CLPV_NORMAL_ZERO) * (1.0f / CLPV_NORMAL_STEPS),
              v = (row - CLPV_NORMAL_ZERO) * (1.0f / CLPV_NORMAL_STEPS);
  const realW z = 1.0f - fabs(u) - fabs(v);
  const realW x = z < ZERO ? fold_octahedron(u, v) : u, y = z < ZERO ? fold_octahedron(v, u) : v;
  const realW scale = rsqrt(x * x + y * y + z * z);
  const intW apart = number > ZERO;
  return (Vec){apart ? scale * x : shading.x, apart ? scale * y : shading.y,
               apart ? scale * z : shading.z};
}
