// SPDX-License-Identifier: MIT
// Late light from a coarser cascade to the next finer one, whose cells are half as wide.
//
// In: light of the coarser cascade (`coarser`), and what the finer one has so far. Out: their sum [W/sr]. The coarser light is
// resampled trilinearly at the finer cells' centres, zero beyond its grid; a cell of a quarter of the area takes a
// quarter of the intensity for the same irradiance (docs/method.md, 'Late light').
//
// dx, dy, dz: from the coarser grid's least corner to the finer one's, in finer cells (finer.h). A work-item is a cell of
// one channel, or CLPV_LANES cells side by side.
#include "coefficients.h"
#include "finer.h"
#include "volume/light.h"
#include "volume/whole_groups.h"

// The four coarser rows round finer cells, from coarser cell x on: their mean in y and z, in finer cells' units.
CLPV_INLINE Coefficients clpv_row(CLPV_VOLUME_IN coarser, const int channel, const int x, const int uy,
                                  const int uz) {
  const int y = CLPV_LOWER(uy), z = CLPV_LOWER(uz);
  const float area = 0.25f, ty = CLPV_UPPER_WEIGHT(uy), tz = CLPV_UPPER_WEIGHT(uz);
  Coefficients row = clpv_zero();
  row = clpv_add_scaled(row, area * (1.0f - ty) * (1.0f - tz), light_load(coarser, channel, x, y, z));
  row = clpv_add_scaled(row, area * ty * (1.0f - tz), light_load(coarser, channel, x, y + 1, z));
  row = clpv_add_scaled(row, area * (1.0f - ty) * tz, light_load(coarser, channel, x, y, z + 1));
  return clpv_add_scaled(row, area * ty * tz, light_load(coarser, channel, x, y + 1, z + 1));
}

#if CLPV_LANES == 8
// Finer cells ux to ux + 7.
CLPV_INLINE Coefficients clpv_resample(CLPV_VOLUME_IN coarser, const int channel, const int ux, const int uy,
                                       const int uz) {
  const Coefficients row = clpv_row(coarser, channel, CLPV_LOWER(ux), uy, uz);
  Coefficients r;
  if (ux & 1) {
#define CLPV_DO(i) r.c##i = CLPV_ODD(row.c##i);
    CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  } else {
#define CLPV_DO(i) r.c##i = CLPV_EVEN(row.c##i);
    CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  }
  return r;
}
#else
CLPV_INLINE Coefficients clpv_resample(CLPV_VOLUME_IN coarser, const int channel, const int ux, const int uy,
                                       const int uz) {
  const int x = CLPV_LOWER(ux);
  const float t = CLPV_UPPER_WEIGHT(ux);
  const Coefficients upper = clpv_row(coarser, channel, x + 1, uy, uz);
  const Coefficients lower = clpv_row(coarser, channel, x, uy, uz);
  return clpv_add_scaled(clpv_add_scaled(clpv_zero(), 1.0f - t, lower), t, upper);
}
#endif

__kernel __attribute__((reqd_work_group_size(CLPV_LOCAL_X, CLPV_LOCAL_Y, 1))) void carry_late(
    CLPV_VOLUME_IN coarser, CLPV_VOLUME_IN sum_so_far, CLPV_VOLUME_OUT sum, const int dx, const int dy,
    const int dz) {
  const int x = CLPV_LANES * (int)get_global_id(0), y = (int)get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  CLPV_RETURN_OUTSIDE(x, y);
  const Coefficients carried = clpv_resample(coarser, channel, x + dx, y + dy, z + dz);
  light_store(sum, channel, x, y, z, clpv_add(light_load(sum_so_far, channel, x, y, z), carried));
}
