// SPDX-License-Identifier: MIT
// Sizes of planes of pixels with an empty border (gather/pixel_planes.h), shared by host and
// kernels.
#pragma once

enum {
  CLPV_PLANE_TILE = 4,  // side of a tile [pixels]; its 4 x 4 pixels have different ray directions
  CLPV_PLANE_COLUMNS =
      8,  // empty columns before and at least as many after each row, for the filter's window
  CLPV_PLANE_ROWS = 3,  // empty rows above and below
};

// First row of the second layer (near_points.cl); at least CLPV_PLANE_ROWS empty rows lie before
// it.
static inline unsigned int second_plane_row(const unsigned int height) {
  return (height + CLPV_PLANE_ROWS + CLPV_PLANE_TILE - 1) / CLPV_PLANE_TILE * CLPV_PLANE_TILE;
}

// Numbers of a row and of a plane of `width` x `height` pixels, the rows of both layers.
static inline unsigned int pixel_plane_pitch(const unsigned int width) {
  return (width + 7) / 8 * 8 + 2 * CLPV_PLANE_COLUMNS;
}
static inline unsigned int pixel_plane_size(const unsigned int width, const unsigned int height) {
  return pixel_plane_pitch(width) * (height + 2 * CLPV_PLANE_ROWS);
}
