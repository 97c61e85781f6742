// SPDX-License-Identifier: MIT
// What surface.h tells of a pixel, of eight in a row.
#ifndef CLPV_SURFACE_ROW_H
#define CLPV_SURFACE_ROW_H

#include "lanes.h"
#include "surface.h"
#include "tile_row.h"
#include "vec.h"

// (sx, sy) of the pixels' centres, times `scale`.
typedef struct {
  float8 x, y;
} OnScreen;

static inline OnScreen on_screen(const ClpvView view, const Eight p) {
  const OnScreen s = {(2.0f * (p.x + 0.5f) / (float)view.width - 1.0f) * view.half_width,
                      (1.0f - 2.0f * (p.y + 0.5f) / (float)view.height) * view.half_height};
  return s;
}

// The surface points [m] at `depth` [m] behind the pixels.
static inline Vec positions(const ClpvView view, const Eight p, const float8 depth) {
  const OnScreen s = on_screen(view, p);
  const float8 scale = view.orthographic != 0.0f ? (float8)(1.0f) : depth;
  const float8 sx = scale * s.x, sy = scale * s.y;
#define CLPV_AT(a) (view.eye[a] + depth * view.forward[a] + sx * view.right[a] + sy * view.up[a])
  return vec(CLPV_AT(0), CLPV_AT(1), CLPV_AT(2));
#undef CLPV_AT
}

// Areas [m^2] of the pixels' footprints across their rays.
static inline float8 footprints(const ClpvView view, const Eight p, const float8 depth) {
  const float pixel = 4.0f * view.half_width * view.half_height / ((float)view.width * (float)view.height);
  if (view.orthographic != 0.0f) return (float8)(pixel);
  const OnScreen s = on_screen(view, p);
  return depth * depth * pixel * rsqrt(1.0f + s.x * s.x + s.y * s.y);
}

// What eight pixels see.
typedef struct {
  uint first;  // the first one's place in the view
  float8 depth;
  Vec position, normal;
} Surfaces;

// Lanes beyond the view have the last pixel's.
static inline void surfaces(const ClpvView view, const Eight p, __global const float* depths,
                            __global const float4* normals, Surfaces* s) {
  s->first = p.py * view.width + p.px;
  const uint8 pixel = s->first + min((uint8)(0, 1, 2, 3, 4, 5, 6, 7), (uint8)(p.count - 1));
  Rows rows;
  gather_rows(normals, pixel, &rows);
  s->depth = (float8)CLPV_GATHER(depths, pixel);
  s->normal = vec(CLPV_COLUMN(rows, x), CLPV_COLUMN(rows, y), CLPV_COLUMN(rows, z));
  s->position = positions(view, p, s->depth);
}

#endif
