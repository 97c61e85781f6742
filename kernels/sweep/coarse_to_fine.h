// SPDX-License-Identifier: MIT
// Linear interpolation from a coarser cascade to a finer one, whose cells are half as wide.
//
// Along an axis, u is the number of a finer cell from the coarser grid's origin. Its centre is (u - 1/2) / 2 coarser
// cells from the first coarser centre, always 1/4 of a cell off one, so that its two neighbours have the weights 3/4
// and 1/4.
#pragma once

// Lower one of the two coarser cells about finer cell u, and the weight of the upper one.
#define CLPV_LOWER(u) (((u) - 1) >> 1)
#define CLPV_UPPER_WEIGHT(u) ((u) & 1 ? 0.25f : 0.75f)

// Finer cells u to u + 7, from eight coarser cells that start with CLPV_LOWER(u); for odd and even u.
#define CLPV_ODD(v)                                                               \
  (0.75f * (float8)((v).s0, (v).s1, (v).s1, (v).s2, (v).s2, (v).s3, (v).s3, (v).s4) + \
   0.25f * (float8)((v).s1, (v).s0, (v).s2, (v).s1, (v).s3, (v).s2, (v).s4, (v).s3))
#define CLPV_EVEN(v)                                                              \
  (0.75f * (float8)((v).s1, (v).s1, (v).s2, (v).s2, (v).s3, (v).s3, (v).s4, (v).s4) + \
   0.25f * (float8)((v).s0, (v).s2, (v).s1, (v).s3, (v).s2, (v).s4, (v).s3, (v).s5))
