// SPDX-License-Identifier: MIT
// A reflective shadow map, shared by host and kernels. Include light.h and view.h before.
#pragma once

typedef struct {
  ClpvView view;
  ClpvLight light;
  float colour_scale;  // of the surface (raster/surface.h)
  unsigned int first;  // index of its first texel in the surface's buffers
} ClpvLitView;
