// SPDX-License-Identifier: MIT
// From a coarser cascade's cells to a finer one's, which are half as wide: trilinear at their centres.
//
// Along an axis, u is a finer cell counted from the coarser grid's least corner. Its centre stands at (u - 1/2) / 2 coarser
// cells from the first coarser centre: always a quarter of a cell off one, so that its two neighbours weigh 3/4 and 1/4.
#ifndef CLPV_COARSE_TO_FINE_H
#define CLPV_COARSE_TO_FINE_H

// Of the two coarser cells round finer cell u: the lower one, and the weight of the upper one.
#define CLPV_LOWER(u) (((u) - 1) >> 1)
#define CLPV_UPPER_WEIGHT(u) ((u) & 1 ? 0.25f : 0.75f)

// Finer cells u to u + 7 from the eight coarser ones that start with the lower of the first one's two, u odd or even.
#define CLPV_ODD(v)                                                               \
  (0.75f * (float8)((v).s0, (v).s1, (v).s1, (v).s2, (v).s2, (v).s3, (v).s3, (v).s4) + \
   0.25f * (float8)((v).s1, (v).s0, (v).s2, (v).s1, (v).s3, (v).s2, (v).s4, (v).s3))
#define CLPV_EVEN(v)                                                              \
  (0.75f * (float8)((v).s1, (v).s1, (v).s2, (v).s2, (v).s3, (v).s3, (v).s4, (v).s4) + \
   0.25f * (float8)((v).s0, (v).s2, (v).s1, (v).s3, (v).s2, (v).s4, (v).s3, (v).s5))

#endif
