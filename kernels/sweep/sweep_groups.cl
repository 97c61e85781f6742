// SPDX-License-Identifier: MIT
// Sweeps whole bins through a cascade, for GPUs: a work-group takes one channel of a bin through
// all planes, upstream to downstream, with D of a plane in local memory. The channels of a bin do
// not depend on each other, nor do bins.
//
//   D = I + sum_k t_k T_k D_k,   L s^2 = sum_d share_d D_d
//
// Discrete ordinates by short characteristics (sweep_cell.h; docs/method.md, 'The sweep'). Numbers
// are added in the order of sweep_planes.cl, with the same result, in one launch in place of one
// per plane.
//
// In, out: as sweep_bin (sweep_bins.cl), without a medium. plane_buffer is only read.
// From the host: CLPV_ITEMS, work-items of a group; the literals of sweep_cell.h.
#include "shared/sweep.h"
#include "sweep/halo_cells.h"
#include "sweep/sweep_cell.h"

enum {
  CLPV_SIDE = CLPV_GRID + 2,  // side of a plane in local memory, with a border of one cell
  CLPV_CELLS = CLPV_GRID * CLPV_GRID,
  CLPV_EACH = (CLPV_CELLS + CLPV_ITEMS - 1) / CLPV_ITEMS,  // cells of a work-item
};

static inline int local_index(const int part, const int row, const int column) {
  return (part * CLPV_SIDE + row + 1) * CLPV_SIDE + column + 1;
}

// Transmittance of a cell's links, for a plane ahead: memory takes longer than a plane.
static inline void load_links(const BinSweep* s, const int plane, const int cell, float* links) {
#if CLPV_BLOCKING
  const int at = sweep_index(plane, cell / CLPV_GRID, cell % CLPV_GRID);
  for (int k = 0; k < 4; ++k)
    links[k] = read_numbers(s->links + s->bin.links[k] * CLPV_SWEEP_VOLUME, at);
#endif
}

// Adds I to D of a cell and to `sum`.
static inline void add_light(const BinSweep* s, const int channel, const int source, float* d,
                             float* sum) {
  if (!holds_sources(s->lit, source)) return;
  float lacking[CLPV_PARTS], injected[CLPV_PARTS];
#if CLPV_COSINE_REST
  find_cosine_rest(s->means, s->sources, source, lacking);
#endif
  load_injected(s, channel, source, lacking, injected);
  for (int part = 0; part < CLPV_PARTS; ++part) {
    d[part] += injected[part];
    *sum = fma(s->directions[part].share, injected[part], *sum);
  }
}

// D of a cell in all parts of the bin. `from`: D of the previous plane.
static inline void sweep_channel(const BinSweep* s, const int channel, __local const float* from,
                                 const float* links, const int plane, const int cell, float* d) {
  const int row = cell / CLPV_GRID, column = cell % CLPV_GRID;
  const int by_column = -s->bin.column_sign, by_row = -s->bin.row_sign * CLPV_SIDE;
  float sum = 0.0f;
  for (int part = 0; part < CLPV_PARTS; ++part) {
    float t[4];
    for (int k = 0; k < 4; ++k) {
      t[k] = s->directions[part].taps[k];
#if CLPV_BLOCKING
      t[k] *= links[k];
#endif
    }
    __local const float* here = from + local_index(part, row, column);
    float light = t[0] * here[0];
    light = fma(t[1], here[by_column], light);
    light = fma(t[2], here[by_row], light);
    light = fma(t[3], here[by_row + by_column], light);
    d[part] = light;
    sum = fma(s->directions[part].share, light, sum);
  }
  add_light(s, channel, plane * s->bin.plane + row * s->bin.row + column, d, &sum);
  write_numbers(s->sums + (channel * CLPV_SWEEP_BINS + s->number) * CLPV_SWEEP_VOLUME,
                sweep_index(plane, row, column), sum);
}

// Sets what the next plane reads beside the grid: the row, then the column upstream.
static inline void set_border(const BinSweep* s, const int channel, const int dark, const int plane,
                              __local float* d) {
  const int row = upstream_of_grid(s->bin.row_sign), column = upstream_of_grid(s->bin.column_sign);
  for (int i = get_local_id(0); i < CLPV_PARTS * CLPV_SIDE; i += CLPV_ITEMS) {
    const int part = i / CLPV_SIDE, at = i % CLPV_SIDE - 1,
              ordinate = ordinate_of(s->number, channel, part);
    const int rows = border_index(ordinate, CLPV_BORDER_ROW, plane, at),
              columns = border_index(ordinate, CLPV_BORDER_COLUMN, plane, at);
    if (at >= 0 && at < CLPV_GRID)
      d[local_index(part, row, at)] = dark ? 0.0f : read_numbers(s->border, rows);
    d[local_index(part, at, column)] = dark ? 0.0f : read_numbers(s->border, columns);
  }
}

__kernel __attribute__((reqd_work_group_size(CLPV_ITEMS, 1, 1))) void sweep_group(
    CLPV_SWEEP_PARAMETERS(dark)) {
  __local float d[CLPV_PARTS * CLPV_SIDE * CLPV_SIDE];
  const int item = get_local_id(0);
  const int b = (int)get_group_id(0) / 3, channel = (int)get_group_id(0) % 3;
  const ClpvSweepBin bin = bins[b];
  BinSweep s = CLPV_SWEEP_OF_BIN(b);
  select_bin(&s);
  for (int i = item; i < CLPV_PARTS * CLPV_SIDE * CLPV_SIDE; i += CLPV_ITEMS) {
    const int part = i / (CLPV_SIDE * CLPV_SIDE), cell = i % (CLPV_SIDE * CLPV_SIDE);
    const int at = ordinate_of(b, channel, part) * CLPV_BORDERED_PLANE +
                   plane_index(cell / CLPV_SIDE - 1, cell % CLPV_SIDE - 1);
    d[i] = dark ? 0.0f : plane_buffer[at];
  }
  const int first = bin.plane_sign > 0 ? 0 : CLPV_GRID - 1;
  float next[CLPV_EACH][CLPV_PARTS], open[CLPV_EACH][4];
  for (int i = 0; i < CLPV_EACH; ++i)
    load_links(&s, first, min(item + i * (int)CLPV_ITEMS, CLPV_CELLS - 1), open[i]);
  for (int p = 0; p < CLPV_GRID; ++p) {
    const int plane = first + p * bin.plane_sign,
              ahead = clamp(plane + bin.plane_sign, 0, CLPV_GRID - 1);
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int i = 0; i < CLPV_EACH; ++i) {
      const int cell = item + i * CLPV_ITEMS;
      if (cell >= CLPV_CELLS) break;
      sweep_channel(&s, channel, d, open[i], plane, cell, next[i]);
      load_links(&s, ahead, cell, open[i]);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    for (int i = 0; i < CLPV_EACH; ++i) {
      const int cell = item + i * CLPV_ITEMS, row = cell / CLPV_GRID, column = cell % CLPV_GRID;
      if (cell >= CLPV_CELLS) break;
      for (int part = 0; part < CLPV_PARTS; ++part) {
        d[local_index(part, row, column)] = next[i][part];
        store_halo_cell(&s, halo, ordinate_of(b, channel, part), (int3)(column, row, plane),
                        next[i][part]);
      }
    }
    set_border(&s, channel, dark, plane, d);
  }
}
