// SPDX-License-Identifier: MIT
// Propagates light by one step, from every cell to its six neighbours, and adds it to the sum of all steps.
//
//   F = max(0, Omega_f I(w_f)) T_f,   c += (F / pi) c(n_f)      for the five visible faces f of each neighbour
//
// Kaplanyan and Dachsbacher 2010, 'Cascaded light propagation volumes'; docs/method.md, 'Propagation'. The transport
// itself (CLPV_ARRIVE, expand_fluxes) is straight-line code with literal constants, from
// host/codegen/transport_source.cpp.
//
// In:   source         light of the previous step (the injected field at first): coefficients [W/sr] per channel, or
//                      with --state fluxes the flux [W] through the cell's six faces
//       sum_so_far     sum of the previous steps, which may be the same memory as `sum`
//       transmittance  with CLPV_BLOCKING: T of each link into a cell (transmittance.cl)
//       least          with CLPV_FIRST_TOO: lower bound of T; 1 in the first step, which is not blocked, else 0
// Out:  target         light of this step
//       sum            sum_so_far + target
// A work-item computes W cells of a row, in one channel or in all three (CLPV_CHANNELS), which then share T.
#include "volume/coefficients.h"
#include "volume/whole_groups.h"

#define CLPV_VOLUME source
#define CLPV_VOLUME_N CLPV_GRID
#define CLPV_VOLUME_CELL Source
#define CLPV_VOLUME_EACH CLPV_EACH_SOURCE
#define CLPV_VOLUME_COUNT CLPV_SOURCE_N
#include "volume/instance.h"

#define CLPV_VOLUME target
#define CLPV_VOLUME_N CLPV_GRID
#define CLPV_VOLUME_CELL Target
#define CLPV_VOLUME_EACH CLPV_EACH_TARGET
#define CLPV_VOLUME_COUNT CLPV_TARGET_N
#include "volume/instance.h"

#include "volume/light.h"

#if CLPV_BLOCKING
#include "volume/transmittance.h"
#endif

CLPV_INLINE Target target_sum(const Target a, const Target b) {
  Target r;
#define CLPV_DO(i) r.c##i = a.c##i + b.c##i;
  CLPV_EACH_TARGET(CLPV_DO)
#undef CLPV_DO
  return r;
}

// Loads a neighbour of cell (x, y, z) in `channel`, for the generated code.
#define CLPV_LOAD_NEIGHBOUR(i, dx, dy, dz) \
  const Source a##i = source_load(source, channel, x + (dx), y + (dy), z + (dz));

#ifndef CLPV_LOBES_AT_RUN_TIME
#define CLPV_LOBES_AT_RUN_TIME 0
#endif
#if CLPV_LOBES_AT_RUN_TIME
#include "steps/run_time_lobes.h"
#endif

#define CLPV_STEP_CHANNEL(CHANNEL)                                                                           \
  {                                                                                                          \
    const int channel = CHANNEL;                                                                             \
    CLPV_EACH_NEIGHBOUR(CLPV_LOAD_NEIGHBOUR)                                                                 \
    CLPV_ARRIVE                                                                                              \
    target_store(target, channel, x, y, z, gained);                                                          \
    target_store(sum, channel, x, y, z, target_sum(target_load(sum_so_far, channel, x, y, z), gained)); \
  }

__kernel __attribute__((reqd_work_group_size(CLPV_LOCAL_X, 1, 1))) void propagate_step(
    CLPV_VOLUME_IN source, CLPV_VOLUME_OUT target, CLPV_VOLUME_IN sum_so_far, CLPV_VOLUME_OUT sum
#if CLPV_BLOCKING
    , CLPV_VOLUME_IN transmittance
#if CLPV_FIRST_TOO
    , const float least
#endif
#endif
#if CLPV_LOBES_AT_RUN_TIME
    , __global const float4* normals, __global const float4* links CLPV_AND_TABLE CLPV_AND_FUNCTIONS
#endif
) {
  const int x = W * (int)get_global_id(0), y = (int)get_global_id(1), z = (int)get_global_id(2) % CLPV_GRID;
  CLPV_RETURN_OUTSIDE(x, y);
#if CLPV_BLOCKING
  Links t = transmittance_load(transmittance, 0, x, y, z);
#if CLPV_FIRST_TOO
#define CLPV_DO(i) t.c##i = max(t.c##i, (realW)(least));
  CLPV_EACH_LINK(CLPV_DO)
#undef CLPV_DO
#endif
#endif
#if CLPV_LOBES_AT_RUN_TIME
  CLPV_STEP_WITH_LOBES
#elif CLPV_CHANNELS == 3
  CLPV_STEP_CHANNEL(0)
  CLPV_STEP_CHANNEL(1)
  CLPV_STEP_CHANNEL(2)
#else
  CLPV_STEP_CHANNEL((int)get_global_id(2) / CLPV_GRID)
#endif
}

// Ends a propagation of fluxes: accumulated = base + expand(sum). base: injected field [W/sr]; sum: fluxes of all steps
// [W].
__kernel __attribute__((reqd_work_group_size(CLPV_LOCAL_X, 1, 1))) void propagate_expand(
    CLPV_VOLUME_IN base, CLPV_VOLUME_IN sum, CLPV_VOLUME_OUT accumulated) {
  const int x = W * (int)get_global_id(0), y = (int)get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  CLPV_RETURN_OUTSIDE(x, y);
  const Coefficients gained = expand_fluxes(target_load(sum, channel, x, y, z));
  light_store(accumulated, channel, x, y, z, add_coefficients(light_load(base, channel, x, y, z), gained));
}
