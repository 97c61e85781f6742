// SPDX-License-Identifier: MIT
// What blockers let through, for a sweep: the transmittance of each link into a cell, in volumes of planes (sweep.h).
//
// In: geometry volume, samples at the cells' corners. Out: `through`, a volume for each axis and link that directions across
// it use. CLPV_TRANSMITTANCE and Links are kernels/transmittance.cl's; CLPV_EACH_X_LINK(DO) and the like write DO(place, link),
// those across x first.
// A work-item is a tile of CLPV_LANES x CLPV_LANES cells of a slice.
#include "coefficients.h"
#include "sweep.h"
#include "volume/geometry.h"

#define CLPV_LOAD_CORNER(i) \
  const Coefficients g##i = geometry_load(blockers, 0, x + (i & 1), y + r + ((i >> 1) & 1), z + (i >> 2));

__kernel void sweep_links(CLPV_VOLUME_IN blockers, CLPV_BUFFER_OUT through) {
  const int x = CLPV_LANES * (int)get_global_id(0), y = CLPV_LANES * (int)get_global_id(1);
  const int z = (int)get_global_id(2);
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  Tile tile[CLPV_X_LINKS];
  for (int r = 0; r < CLPV_LANES; ++r) {
    if (y + r < CLPV_GRID) {
      CLPV_LOAD_CORNER(0) CLPV_LOAD_CORNER(1) CLPV_LOAD_CORNER(2) CLPV_LOAD_CORNER(3)
      CLPV_LOAD_CORNER(4) CLPV_LOAD_CORNER(5) CLPV_LOAD_CORNER(6) CLPV_LOAD_CORNER(7)
      CLPV_TRANSMITTANCE
      const int across_z = clpv_sweep_at(z, y + r, x), across_y = clpv_sweep_at(y + r, z, x);
#define CLPV_DO(place, link) \
  CLPV_SWEEP_STORE(through + place * CLPV_SWEEP_VOLUME, across_z, CLPV_WITHIN(x, links.c##link));
      CLPV_EACH_Z_LINK(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(place, link) \
  CLPV_SWEEP_STORE(through + place * CLPV_SWEEP_VOLUME, across_y, CLPV_WITHIN(x, links.c##link));
      CLPV_EACH_Y_LINK(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(place, link) tile[place].row[r] = links.c##link;
      CLPV_EACH_X_LINK(CLPV_DO)
    } else {
#undef CLPV_DO
#define CLPV_DO(place, link) tile[place].row[r] = 0.0f;
      CLPV_EACH_X_LINK(CLPV_DO)
#undef CLPV_DO
    }
  }
  for (int w = 0; w < CLPV_X_LINKS; ++w) {
    const Tile turned = clpv_turn(tile[w]);
    for (int r = 0; r < CLPV_LANES; ++r) {
      if (x + r >= CLPV_GRID) break;
      CLPV_SWEEP_STORE(through + w * CLPV_SWEEP_VOLUME, clpv_sweep_at(x + r, z, y), turned.row[r]);
    }
  }
}
