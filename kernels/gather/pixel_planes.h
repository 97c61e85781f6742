// SPDX-License-Identifier: MIT
// Planes of one number per pixel, with an empty border (shared/pixel_planes.h), of the near field
// and of media.
//
// A block of CLPV_PLANE_STEP x CLPV_PLANE_STEP pixels of the camera has a pixel in each of
// CLPV_PLANE_LAYERS layers, the second layer below the first.
//
// From the host: CLPV_PLANE_STEP (1, 2, 4 or 8), CLPV_PLANE_LAYERS (1 or 2).
#pragma once

#include "lanes.h"
#include "shared/pixel_planes.h"
#include "shared/view.h"
#include "vec.h"

// W pixels of a row.
typedef struct {
  uint width, height;  // size of all layers [pixels]
  uint pitch, plane;   // floats per row and per plane
  int x, y;                          // first pixel; may be in the border
  uint at;                           // its index in a plane
} PlaneRow;

static inline uint plane_pixels(const uint pixels) {
  return (pixels + CLPV_PLANE_STEP - 1) / CLPV_PLANE_STEP;
}

// First row of the second layer, and the number of rows of all layers.
static inline uint second_layer_row(const ClpvView view) {
  return second_plane_row(plane_pixels(view.height));
}
static inline uint plane_rows(const ClpvView view) {
  const uint height = plane_pixels(view.height);
  return CLPV_PLANE_LAYERS == 1 ? height : second_plane_row(height) + height;
}
static inline uint plane_size(const ClpvView view) {
  return pixel_plane_size(plane_pixels(view.width), plane_rows(view));
}

// The pixels from (W column, row) on.
static inline PlaneRow find_plane_row(const ClpvView view, const int column, const int row) {
  PlaneRow r;
  r.width = plane_pixels(view.width);
  r.height = plane_rows(view);
  r.pitch = pixel_plane_pitch(r.width);
  r.plane = plane_size(view);
  r.x = column * W;
  r.y = row;
  r.at = (uint)(row + CLPV_PLANE_ROWS) * r.pitch + (uint)(r.x + CLPV_PLANE_COLUMNS);
  return r;
}

// False past the last column or row, since launches are rounded up.
static inline bool row_has_pixels(const PlaneRow r) {
  return r.x < (int)r.width && r.y < (int)r.height;
}

// Vectors from three planes.
CLPV_INLINE Vec load_plane_vectors(__global const float* planes, const uint plane, const uint at) {
  return vec(load_lanes(planes + at), load_lanes(planes + plane + at),
             load_lanes(planes + 2 * plane + at));
}
CLPV_INLINE void store_plane_vectors(const Vec v, __global float* planes, const uint plane,
                                     const uint at) {
  store_lanes(v.x, planes + at);
  store_lanes(v.y, planes + plane + at);
  store_lanes(v.z, planes + 2 * plane + at);
}
