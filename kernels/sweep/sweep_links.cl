// SPDX-License-Identifier: MIT
// Computes the transmittance of each link into a cell for the sweep: of the sample points about it
// that see an end, the share that see both (docs/method.md, 'The sweep').
//
//   T = S_ab / (S_a + S_b - S_ab) (1 - clamp(B, 0, 1))    0 if no point sees an end
//
// S_a and S_b are the points that see centres a and b, S_ab those that see both, in all cubes that
// the link crosses; B is the blocking potential (steps/link_transmittance.h).
//
// Out:  transmittance  T in [0, 1], a volume for each axis and link that directions across it use
//                      (sweep_layout.h)
// In:   blockers       with CLPV_POTENTIAL, else B = 0: geometry volume, samples at the cells'
//                      corners
//       hidden         with CLPV_POINTS, else all are seen: hidden points of each cube between
//                      cells (seen_points.cl)
// From the host (host/pipeline/sweep/sweep_literals.cpp): these two, literals of
// link_transmittance.h, and CLPV_VOLUME_LINKS, the link of each volume: CLPV_AXIS_LINKS across x,
// then as many across y and z. A work-item computes a tile of W x W cells of a slice.
#include "volume/coefficients.h"
#include "steps/link_transmittance.h"
#include "sweep/sweep_tiles.h"

__constant const int volume_links[3 * CLPV_AXIS_LINKS] = CLPV_VOLUME_LINKS;

#if CLPV_POINTS
// W words of a row of cubes, from index `at` on.
CLPV_INLINE intW read_words(__global const int* from, const int at) {
#if W == 8
  return vload8(0, from + at);
#else
  return from[at];
#endif
}

// Byte `number` of W cubes: hidden points of a pair or a centre.
CLPV_INLINE intW hidden_points(__global const int* hidden, const int cube, const int number) {
  const intW words = read_words(hidden, number / 4 * CLPV_BORDERED_VOLUME + cube);
  return words >> 8 * (number % 4) & 255;
}

// Returns true if the link that passes sides sx, sy and sz crosses the cube at octant o of a cell.
static inline bool crosses(const int o, const int sx, const int sy, const int sz) {
  return (sx == 0 || (o & 1) == (sx > 0)) && (sy == 0 || (o >> 1 & 1) == (sy > 0)) &&
         (sz == 0 || (o >> 2) == (sz > 0));
}

// Multiplies T of every link into W cells by the share of points. A cell's centre is number 7 - o
// in the cube at its octant o.
CLPV_INLINE Links seen_shares(Links links, __global const int* hidden, const int x, const int y,
                              const int z) {
#pragma unroll
  for (int link = 0; link < CLPV_LINKS; ++link) {
    const int sx = link_sides[3 * link], sy = link_sides[3 * link + 1],
              sz = link_sides[3 * link + 2];
    intW both = 0, either = 0;
#pragma unroll
    for (int o = 0; o < 8; ++o) {
      const int cube = bordered_index(z - 1 + (o >> 2), y - 1 + (o >> 1 & 1), x - 1 + (o & 1));
      const int here = 7 - o, there = here + sx + 2 * sy + 4 * sz;
      if (crosses(o, sx, sy, sz)) {
        const intW from_one =
            hidden_points(hidden, cube, pair_number(min(here, there), max(here, there)));
        both += CLPV_CUBE_POINTS - from_one;
        either += CLPV_CUBE_POINTS + from_one -
                  hidden_points(hidden, cube, centre_number(here)) -
                  hidden_points(hidden, cube, centre_number(there));
      }
    }
    links.c[link] *= to_realW(both) / fmax(to_realW(either), ONE);
  }
  return links;
}

#endif

#if !CLPV_POTENTIAL
CLPV_INLINE Links open_links(void) {
  Links links;
#pragma unroll
  for (int link = 0; link < CLPV_LINKS; ++link) links.c[link] = ONE;
  return links;
}
#endif

__kernel void sweep_links(CLPV_BUFFER_OUT transmittance
#if CLPV_POTENTIAL
                          ,
                          CLPV_VOLUME_IN blockers
#endif
#if CLPV_POINTS
                          ,
                          __global const int* hidden
#endif
) {
  const int x = W * (int)get_global_id(0), y = W * (int)get_global_id(1);
  const int z = (int)get_global_id(2);
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  SweepTile tiles[CLPV_AXIS_LINKS];
  for (int v = 0; v < CLPV_AXIS_LINKS; ++v) {
    for (int r = 0; r < W; ++r) tiles[v].row[r] = 0.0f;
  }
  for (int r = 0; r < W && y + r < CLPV_GRID; ++r) {
#if CLPV_POTENTIAL
    Links links = find_transmittance(blockers, x, y + r, z);
#else
    Links links = open_links();
#endif
#if CLPV_POINTS
    links = seen_shares(links, hidden, x, y + r, z);
#endif
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
