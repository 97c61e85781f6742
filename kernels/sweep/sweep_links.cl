// SPDX-License-Identifier: MIT
// Computes the transmittance of each link into a cell for the sweep: 1 minus the blocking potential.
//
//   T = 1 - clamp(B, 0, 1)      (docs/method.md, 'Blockers')
//
// In:   blockers       geometry volume, samples at the cells' corners
// Out:  transmittance  T in [0, 1], a volume for each axis and link that directions across it use (sweep_layout.h)
// From the host (host/codegen/transmittance_source.cpp, sweep_source.cpp): CLPV_TRANSMITTANCE and struct Links, as in
// transmittance.cl, and CLPV_EACH_X_LINK(DO), _Y_, _Z_, which write DO(volume, link), links across x first.
// A work-item computes a tile of W x W cells of a slice.
#include "volume/coefficients.h"
#include "sweep/sweep_tiles.h"
#include "volume/geometry.h"

#define CLPV_LOAD_CORNER(i) \
  const Coefficients g##i = geometry_load(blockers, 0, x + (i & 1), y + r + ((i >> 1) & 1), z + (i >> 2));

__kernel void sweep_links(CLPV_VOLUME_IN blockers, CLPV_BUFFER_OUT transmittance) {
  const int x = W * (int)get_global_id(0), y = W * (int)get_global_id(1);
  const int z = (int)get_global_id(2);
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  SweepTile tiles[CLPV_X_LINKS];
  for (int r = 0; r < W; ++r) {
    if (y + r < CLPV_GRID) {
      CLPV_LOAD_CORNER(0) CLPV_LOAD_CORNER(1) CLPV_LOAD_CORNER(2) CLPV_LOAD_CORNER(3)
      CLPV_LOAD_CORNER(4) CLPV_LOAD_CORNER(5) CLPV_LOAD_CORNER(6) CLPV_LOAD_CORNER(7)
      CLPV_TRANSMITTANCE
      const int across_z = sweep_index(z, y + r, x), across_y = sweep_index(y + r, z, x);
#define CLPV_DO(volume, link) \
  CLPV_SWEEP_STORE(transmittance + volume * CLPV_SWEEP_VOLUME, across_z, CLPV_WITHIN(x, links.c##link));
      CLPV_EACH_Z_LINK(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(volume, link) \
  CLPV_SWEEP_STORE(transmittance + volume * CLPV_SWEEP_VOLUME, across_y, CLPV_WITHIN(x, links.c##link));
      CLPV_EACH_Y_LINK(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(volume, link) tiles[volume].row[r] = links.c##link;
      CLPV_EACH_X_LINK(CLPV_DO)
    } else {
#undef CLPV_DO
#define CLPV_DO(volume, link) tiles[volume].row[r] = 0.0f;
      CLPV_EACH_X_LINK(CLPV_DO)
#undef CLPV_DO
    }
  }
  for (int v = 0; v < CLPV_X_LINKS; ++v) store_x_tile(transmittance + v * CLPV_SWEEP_VOLUME, tiles[v], x, y, z);
}
