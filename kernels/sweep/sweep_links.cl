// SPDX-License-Identifier: MIT
// Computes the transmittance of each link into a cell for the sweep: 1 minus the blocking
// potential.
//
//   T = 1 - clamp(B, 0, 1)      (docs/method.md, 'Blockers')
//
// In:   blockers       geometry volume, samples at the cells' corners
// Out:  transmittance  T in [0, 1], a volume for each axis and link that directions across it use
//                      (sweep_layout.h)
// From the host (host/codegen/transmittance_source.cpp, sweep_source.cpp): the text for
// link_transmittance.h, and CLPV_VOLUME_LINKS, the link of each volume: CLPV_AXIS_LINKS across x,
// then as many across y and z. A work-item computes a tile of W x W cells of a slice.
#include "volume/coefficients.h"
#include "steps/link_transmittance.h"
#include "sweep/sweep_tiles.h"

__constant const int volume_links[3 * CLPV_AXIS_LINKS] = CLPV_VOLUME_LINKS;

__kernel void sweep_links(CLPV_VOLUME_IN blockers, CLPV_BUFFER_OUT transmittance) {
  const int x = W * (int)get_global_id(0), y = W * (int)get_global_id(1);
  const int z = (int)get_global_id(2);
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  SweepTile tiles[CLPV_AXIS_LINKS];
  for (int v = 0; v < CLPV_AXIS_LINKS; ++v) {
    for (int r = 0; r < W; ++r) tiles[v].row[r] = 0.0f;
  }
  for (int r = 0; r < W && y + r < CLPV_GRID; ++r) {
    const Links links = find_transmittance(blockers, x, y + r, z);
#pragma unroll
    for (int v = 0; v < CLPV_AXIS_LINKS; ++v) {
      const int across_y = v + CLPV_AXIS_LINKS, across_z = v + 2 * CLPV_AXIS_LINKS;
      tiles[v].row[r] = links.c[volume_links[v]];
      write_numbers(transmittance + across_y * CLPV_SWEEP_VOLUME, sweep_index(y + r, z, x),
                       zero_outside(x, links.c[volume_links[across_y]]));
      write_numbers(transmittance + across_z * CLPV_SWEEP_VOLUME, sweep_index(z, y + r, x),
                       zero_outside(x, links.c[volume_links[across_z]]));
    }
  }
  for (int v = 0; v < CLPV_AXIS_LINKS; ++v)
    store_x_tile(transmittance + v * CLPV_SWEEP_VOLUME, tiles[v], x, y, z);
}
