// SPDX-License-Identifier: MIT
// Computes the transmittance of each link into a cell for the sweep: 1 minus the blocking
// potential.
//
//   T = 1 - clamp(B, 0, 1)      (docs/method.md, 'Blockers')
//   T = 0                       if the link is closed
//   T = max(0, (T - w) / (1 - w))   instead of 0, if a centre at an end of the closed link is
//                               enclosed; w: CLPV_WALL_TRANSMITTANCE
// With `open`, for sweeps of bounces, sqrt(T) or, if the link is closed, 0: light passes the two
// sheets of a wall in two links.
//
// In:   blockers       geometry volume, samples at the cells' corners
//       closed         closed pairs of centres in each cube between cells (closed_links.cl)
// Out:  transmittance  T in [0, 1], a volume for each axis and link that directions across it use
//                      (sweep_layout.h)
// From the host (host/pipeline/sweep/sweep_literals.cpp): literals of link_transmittance.h,
// and CLPV_VOLUME_LINKS, the link of each volume: CLPV_AXIS_LINKS across x, then as many across y
// and z. A work-item computes a tile of W x W cells of a slice.
#include "volume/coefficients.h"
#include "steps/link_transmittance.h"
#include "sweep/sweep_tiles.h"

__constant const int volume_links[3 * CLPV_AXIS_LINKS] = CLPV_VOLUME_LINKS;

// W words of a row of cubes, from index `at` on.
CLPV_INLINE intW read_words(__global const int* from, const int at) {
#if W == 8
  return vload8(0, from + at);
#else
  return from[at];
#endif
}

// Returns true if the link that passes sides sx, sy and sz crosses the cube at octant o of a cell.
static inline bool crosses(const int o, const int sx, const int sy, const int sz) {
  return (sx == 0 || (o & 1) == (sx > 0)) && (sy == 0 || (o >> 1 & 1) == (sy > 0)) &&
         (sz == 0 || (o >> 2) == (sz > 0));
}

// Reduces T on links that are closed in all cubes that they cross. A cell's centre is number 7 - o
// in the cube at its octant o.
CLPV_INLINE Links close_links(Links links, __global const int* closed, const int open,
                              const int x, const int y, const int z) {
  intW cubes[8];
#pragma unroll
  for (int o = 0; o < 8; ++o)
    cubes[o] =
        read_words(closed, bordered_index(z - 1 + (o >> 2), y - 1 + (o >> 1 & 1), x - 1 + (o & 1)));
#pragma unroll
  for (int link = 0; link < CLPV_LINKS; ++link) {
    const int sx = link_sides[3 * link], sy = link_sides[3 * link + 1],
              sz = link_sides[3 * link + 2];
    intW bits = 1;
#pragma unroll
    for (int o = 0; o < 8; ++o) {
      const int here = 7 - o, there = here + sx + 2 * sy + 4 * sz;
      if (crosses(o, sx, sy, sz))
        bits &= cubes[o] >> pair_number(min(here, there), max(here, there));
    }
    const intW neighbour = read_words(closed, bordered_index(z + sz, y + sy, x + sx));
    const intW enclosed = (cubes[7] | neighbour) >> CLPV_ENCLOSED_BIT & bits;
    const float wall = CLPV_WALL_TRANSMITTANCE;
    const realW t = links.c[link], reduced = fmax((t - wall) * (1.0f / (1.0f - wall)), ZERO);
    links.c[link] = to_realW(1 - bits) * (open ? sqrt(t) : t);
    if (!open) links.c[link] += to_realW(enclosed) * reduced;
  }
  return links;
}

__kernel void sweep_links(CLPV_VOLUME_IN blockers, __global const int* closed,
                          const int open, CLPV_BUFFER_OUT transmittance) {
  const int x = W * (int)get_global_id(0), y = W * (int)get_global_id(1);
  const int z = (int)get_global_id(2);
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  SweepTile tiles[CLPV_AXIS_LINKS];
  for (int v = 0; v < CLPV_AXIS_LINKS; ++v) {
    for (int r = 0; r < W; ++r) tiles[v].row[r] = 0.0f;
  }
  for (int r = 0; r < W && y + r < CLPV_GRID; ++r) {
    const Links links =
        close_links(find_transmittance(blockers, x, y + r, z), closed, open, x, y + r, z);
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
