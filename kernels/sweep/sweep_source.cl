// SPDX-License-Identifier: MIT
// Copies injected light into the layout of a sweep.
//
// In:   injected  light volume [W/sr], any basis and layout
// Out:  sources, lit   sources.h
// A work-item copies a tile of W x W cells of a slice.
#include "volume/coefficients.h"
#include "lanes.h"
#include "shared/sweep.h"
#include "sweep/sources.h"
#include "volume/light.h"

__kernel void sweep_source(CLPV_VOLUME_IN injected, CLPV_BUFFER_OUT sources, __global uchar* lit) {
  const int x = W * (int)get_global_id(0), y = W * (int)get_global_id(1), z = (int)get_global_id(2);
  TileLight light = dark_light();
  for (int channel = 0; channel < 3 && x < CLPV_GRID; ++channel) {
    for (int r = 0; r < min(W, CLPV_GRID - y); ++r) {
      const Coefficients c = light_load(injected, channel, x, y + r, z);
      copy_coefficients(&c, &light.row[channel][r]);
    }
  }
  write_sources(&light, sources, lit);
}
