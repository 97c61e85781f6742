// SPDX-License-Identifier: MIT
// One step of a sweep: W cells of a plane, all channels and directions of a bin, for sweep_bins.cl
// and sweep_planes.cl.
//
//   D = I + sum_k t_k T_k D_k                                k: four cells of the previous plane
//   t = (1-t_u)(1-t_v), t_u(1-t_v), (1-t_u)t_v, t_u t_v      of these cells
//   t_u = |w_u| / |w_m|
//   I_w = sum_i c_i (1 / Omega) Int_part b_i dw              I of direction w
//   L_b s^2 = sum_d Omega_d D_d / (|w_m| Omega_b)            d: the directions of bin b
//
// Discrete ordinates by short characteristics (docs/method.md, 'The sweep'). D [W/sr] is the light
// along a direction, I [W/sr] the injected light, with add_cosine_rest() for harmonics, T_k the
// transmittance of the link from cell k, 0 to 1. ClpvSweepDirection has t and the share of a
// direction, BinSweep the means of the basis functions over its part of a bin.
//
// With CLPV_MEDIUM, a medium attenuates light from the previous plane, and scatters some into it:
//
//   D = I + (1 - f a) sum_k t_k T_k D_k + |w_m| a (f J) s^2,   a = 1 - exp(-sigma_t s / |w_m|)
//
// J s^2 [W/sr]: source function of the bin (sweep_medium.cl); f: part of a cell in the medium; f
// and f J are means of the cell and its neighbour upstream along m.
//
// From the host: CLPV_PARTS directions of a bin, CLPV_SOURCES coefficients stored per channel,
// CLPV_EMITTING, how many of them a bin's light depends on, CLPV_BLOCKING, CLPV_MEDIUM,
// CLPV_COSINE_REST, CLPV_SOURCE_LANES, the W of sweep_source.cl.
#pragma once

#include "shared/sweep.h"
#include "sweep/cosine_rest.h"
#include "sweep/sweep_border.h"
#include "sweep/sweep_layout.h"

// The bin that a work-item sweeps, and its buffers.
typedef struct {
  int number;  // index of the bin, 0 to CLPV_SWEEP_BINS - 1
  ClpvSweepBin bin;
  __constant const ClpvSweepDirection* directions;  // CLPV_PARTS of them
  __constant const int* coefficients;  // those that the bin's light depends on, CLPV_EMITTING
  __constant const float* means;       // means of their functions, CLPV_EMITTING for each direction
  CLPV_BUFFER_IN sources;      // c of 3 channels and CLPV_SOURCES coefficients (sweep_source.cl)
  __global const uchar* lit;   // 1 for each CLPV_SOURCE_LANES cells that hold sources
  CLPV_BUFFER_IN links;        // T, a volume for each axis and link
  CLPV_BUFFER_IN border;       // D in the cells beside the grid (sweep_border.h)
  CLPV_BUFFER_OUT sums;        // L s^2, a volume for each channel and bin
  CLPV_BUFFER_OUT halo_light;  // D in the cells of the halo (sweep_border.h)
  // With CLPV_MEDIUM:
  __global const float* inside;  // share of each cell in the medium: one bordered row per axis;
                                 // multiply the three factors
  CLPV_BUFFER_IN scattered;      // J s^2, a volume for each channel and bin
} BinSweep;

// Parameters of the kernels that sweep, and what BinSweep has of them.
#define CLPV_SWEEP_PARAMETERS(last)                                                             \
  __constant const ClpvSweepBin *bins, __constant const ClpvSweepDirection *directions,         \
      __constant const int *coefficients, __constant const float *means, CLPV_BUFFER_IN sources, \
      __global const uchar *lit, CLPV_BUFFER_IN links, CLPV_BUFFER_IN border,                    \
      const ClpvSweepHalo halo, __global float *plane_buffer, CLPV_BUFFER_OUT sums,              \
      CLPV_BUFFER_OUT halo_light, const int last, __global const float *inside,                  \
      CLPV_BUFFER_IN scattered
#define CLPV_SWEEP_OF_BIN(b)                                                                     \
  {b, bins[b], directions, coefficients, means, sources, lit, links, border, sums, halo_light,   \
   inside, scattered}

// Moves pointers from the tables of all bins, the kernel's parameters, to the tables of the bin.
CLPV_INLINE void select_bin(BinSweep* s) {
  s->directions += s->number * CLPV_PARTS;
  s->coefficients += s->number * CLPV_EMITTING;
  s->means += s->number * CLPV_PARTS * CLPV_EMITTING;
  s->sources += s->bin.transposed * 3 * CLPV_SOURCES * CLPV_SWEEP_VOLUME;
  s->lit += s->bin.transposed * CLPV_SWEEP_VOLUME / CLPV_SOURCE_LANES;
}

// Returns true if any of W cells holds sources.
CLPV_INLINE bool holds_sources(__global const uchar* lit, const int source) {
#if CLPV_SOURCE_LANES >= W
  return lit[source / CLPV_SOURCE_LANES] != 0;
#else
  return as_ulong(vload8(0, lit + source)) != 0ul;
#endif
}

// I of a channel in cells with sources. `lacking`: of find_cosine_rest().
CLPV_INLINE void load_injected(const BinSweep* s, const int channel, const int source,
                               const realW* lacking, realW* injected) {
  CLPV_BUFFER_IN of_channel = s->sources + channel * CLPV_SOURCES * CLPV_SWEEP_VOLUME;
#pragma unroll
  for (int part = 0; part < CLPV_PARTS; ++part) injected[part] = 0.0f;
  for (int j = 0; j < CLPV_EMITTING; ++j) {
    const realW c = read_numbers(of_channel + s->coefficients[j] * CLPV_SWEEP_VOLUME, source);
#pragma unroll
    for (int part = 0; part < CLPV_PARTS; ++part)
      injected[part] = fma((realW)(s->means[part * CLPV_EMITTING + j]), c, injected[part]);
  }
#if CLPV_COSINE_REST
  const realW uniform = read_numbers(of_channel, source);
#pragma unroll
  for (int part = 0; part < CLPV_PARTS; ++part)
    injected[part] = fma(uniform, lacking[part], injected[part]);
#endif
}

// Adds I to D in cells with sources, and to `sum`. `planes`: D of the bin's first ordinate there.
CLPV_INLINE void add_sources(const BinSweep* s, const int source, __global float* planes,
                             realW* sum) {
  realW lacking[CLPV_PARTS];
#if CLPV_COSINE_REST
  find_cosine_rest(s->means, s->sources, source, lacking);
#endif
  for (int channel = 0; channel < 3; ++channel) {
    realW injected[CLPV_PARTS];
    load_injected(s, channel, source, lacking, injected);
#pragma unroll
    for (int part = 0; part < CLPV_PARTS; ++part) {
      const int ordinate = ordinate_of(0, channel, part) * CLPV_BORDERED_PLANE;
      store_lanes(load_lanes(planes + ordinate) + injected[part], planes + ordinate);
      sum[channel] = fma((realW)(s->directions[part].share), injected[part], sum[channel]);
    }
  }
}

CLPV_INLINE int inside_index(const int axis, const int i) {
  return axis * CLPV_SWEEP_PITCH + CLPV_SWEEP_FIRST + i;
}

// `from`, `to`: buffers of the previous plane and of this one, which may be the same.
CLPV_INLINE void sweep_cells(const BinSweep* s, __global const float* from, __global float* to,
                             const int plane, const int row, const int column) {
  const ClpvSweepBin bin = s->bin;
  const int at = sweep_index(plane, row, column);
  const int here = ordinate_of(s->number, 0, 0) * CLPV_BORDERED_PLANE + plane_index(row, column);
  __global const float* from0 = from + here;
  __global const float* from1 = from0 - bin.column_sign;
  __global const float* from2 = from0 - bin.row_sign * CLPV_SWEEP_PITCH;
  __global const float* from3 = from2 - bin.column_sign;
#if CLPV_BLOCKING
  realW transmittance[4];
#pragma unroll
  for (int k = 0; k < 4; ++k)
    transmittance[k] = read_numbers(s->links + bin.links[k] * CLPV_SWEEP_VOLUME, at);
#endif
#if CLPV_MEDIUM
  const int upstream = plane - bin.plane_sign;
  const int scattered_upstream =
      upstream < 0 || upstream >= CLPV_GRID ? at : sweep_index(upstream, row, column);
  const realW across = 0.5f * s->inside[inside_index(bin.row_axis, row)] *
                           load_lanes(s->inside + inside_index(bin.column_axis, column));
  const realW inside = across * s->inside[inside_index(bin.plane_axis, plane)],
                  inside_upstream = across * s->inside[inside_index(bin.plane_axis, upstream)];
  realW scattered[3];
#pragma unroll
  for (int channel = 0; channel < 3; ++channel) {
    CLPV_BUFFER_IN volume =
        s->scattered + (channel * CLPV_SWEEP_BINS + s->number) * CLPV_SWEEP_VOLUME;
    scattered[channel] = inside * read_numbers(volume, at) +
                         inside_upstream * read_numbers(volume, scattered_upstream);
  }
#endif
  realW sum[3] = {0.0f, 0.0f, 0.0f};
#pragma unroll
  for (int part = 0; part < CLPV_PARTS; ++part) {
    realW t[4];
#pragma unroll
    for (int k = 0; k < 4; ++k) {
      t[k] = (realW)(s->directions[part].taps[k]);
#if CLPV_BLOCKING
      t[k] *= transmittance[k];
#endif
    }
#pragma unroll
    for (int channel = 0; channel < 3; ++channel) {
      const int ordinate = ordinate_of(0, channel, part) * CLPV_BORDERED_PLANE;
      realW d = t[0] * load_lanes(from0 + ordinate);
      d = fma(t[1], load_lanes(from1 + ordinate), d);
      d = fma(t[2], load_lanes(from2 + ordinate), d);
      d = fma(t[3], load_lanes(from3 + ordinate), d);
#if CLPV_MEDIUM
      const realW lost = 1.0f - s->directions[part].attenuation[channel];
      d = fma(lost,
              s->directions[part].cosine * scattered[channel] - (inside + inside_upstream) * d, d);
#endif
      store_lanes(d, to + here + ordinate);
      sum[channel] = fma((realW)(s->directions[part].share), d, sum[channel]);
    }
  }
  const int source = plane * bin.plane + row * bin.row + column;
  if (holds_sources(s->lit, source)) add_sources(s, source, to + here, sum);
#pragma unroll
  for (int channel = 0; channel < 3; ++channel)
    write_numbers(s->sums + (channel * CLPV_SWEEP_BINS + s->number) * CLPV_SWEEP_VOLUME, at,
                  sum[channel]);
}

CLPV_INLINE int upstream_of_grid(const int sign) { return sign > 0 ? -1 : CLPV_GRID; }

// Copy the boundary condition of a plane into the plane buffer, where the next plane reads it: W
// cells of the row upstream, and of the column upstream (one cell with one lane).
CLPV_INLINE void copy_border_row(const BinSweep* s, __global float* planes, const int ordinate,
                                 const int plane, const int column) {
  planes += ordinate * CLPV_BORDERED_PLANE + plane_index(upstream_of_grid(s->bin.row_sign), column);
  store_lanes(read_numbers(s->border, border_index(ordinate, CLPV_BORDER_ROW, plane, column)),
              planes);
}
CLPV_INLINE void copy_border_column(const BinSweep* s, __global float* planes, const int ordinate,
                                    const int plane, const int row) {
  const realW light =
      read_numbers(s->border, border_index(ordinate, CLPV_BORDER_COLUMN, plane, row));
  planes += ordinate * CLPV_BORDERED_PLANE + plane_index(row, upstream_of_grid(s->bin.column_sign));
#pragma unroll
  for (int i = 0; i < W; ++i)
    if (row + i <= CLPV_GRID) planes[i * CLPV_SWEEP_PITCH] = ((const float*)&light)[i];
}
