// SPDX-License-Identifier: MIT
// Surfels add blocking to a geometry volume; blockers of two sources that see the same surfaces are
// merged (docs/method.md, 'Blockers').
//
//   CLPV_BLOCKS_BY_AREA 1:   |n_x|, |n_y|, |n_z|; the larger of each area
//                       0:   the lobe about the normal; the lobe of the larger mean
//
// From the host: with lobes CLPV_INTEGRALS, the integrals of the basis's functions, and the
// literals of basis/lobe.h.
#pragma once

#include "volume/coefficients.h"

#if CLPV_BLOCKS_BY_AREA

#define CLPV_AND_H
#define CLPV_PASS_H

CLPV_INLINE Coefficients project_blockers(const Coefficients a) { return a; }

CLPV_INLINE Coefficients surfel_blocker(const float x, const float y,
                                        const float z CLPV_AND_H) {
  const Coefficients areas = {{fabs(x), fabs(y), fabs(z)}};
  return areas;
}

CLPV_INLINE Coefficients merge_blockers(const Coefficients a, const Coefficients b) {
  const Coefficients r = {{fmax(a.c[0], b.c[0]), fmax(a.c[1], b.c[1]), fmax(a.c[2], b.c[2])}};
  return r;
}

#else

#include "basis/lobe.h"

__constant const float integrals[CLPV_N] = CLPV_INTEGRALS;

CLPV_INLINE Coefficients project_blockers(const Coefficients a) { return project_sum(a); }

CLPV_INLINE Coefficients surfel_blocker(const float x, const float y,
                                        const float z CLPV_AND_H) {
  return lobe_integrals(x, y, z CLPV_PASS_H);
}

CLPV_INLINE Coefficients merge_blockers(const Coefficients a, const Coefficients b) {
  const bool first = add_product(0.0f, integrals, a) > add_product(0.0f, integrals, b);
  Coefficients r;
#pragma unroll
  for (int i = 0; i < CLPV_N; ++i) r.c[i] = first ? a.c[i] : b.c[i];
  return r;
}

#endif
