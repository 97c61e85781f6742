// SPDX-License-Identifier: MIT
// Surfaces that a launch injects together, shared by host and kernels. All have the same size and
// lie in the same buffers; each has its own volume. Include grid.h and view.h before.
#pragma once

typedef struct {
  ClpvView view;
  ClpvGrid grid;
  float colour_scale;   // of the surface (raster/surface.h)
  unsigned int first;   // index of the surface's first texel in its buffers
  unsigned int volume;  // index of its volume's first number
  unsigned int cascade; // whose occlusion bits belong to the grid (voxels/visibility.cl)
} ClpvInjection;
