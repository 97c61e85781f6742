// SPDX-License-Identifier: MIT
// Eight pixels side by side, computed at once: a row of a tile.
//
// PoCL vectorises work-items only in short kernels of straight-line code on named scalars, without arrays, branches and
// float3 in memory. Such kernels are written so (coefficients.h, surface.h, volume/whole_groups.h); longer ones name their
// eight lanes, and call nothing that PoCL does not expand in place, such as any(), floor() or log2().
#ifndef CLPV_LANES_H
#define CLPV_LANES_H

#define CLPV_ABREAST 8
#define CLPV_COMPONENT float8

// One element for each lane, from where `at` says.
#define CLPV_GATHER(from, at)                                                                            \
  ((from)[(at).s0], (from)[(at).s1], (from)[(at).s2], (from)[(at).s3], (from)[(at).s4], (from)[(at).s5], \
   (from)[(at).s6], (from)[(at).s7])

// Four elements for each lane, gathered at once and then taken column by column: a load a lane instead of four.
typedef struct {
  float4 r0, r1, r2, r3, r4, r5, r6, r7;
} Rows;

// Results of functions that read buffers go out through pointers, here and where these are used: what returns a struct
// and reads memory is annotated by the compiler in a way that Oclgrind does not know.
static inline void gather_rows(__global const float4* from, const uint8 at, Rows* rows) {
  rows->r0 = from[at.s0];
  rows->r1 = from[at.s1];
  rows->r2 = from[at.s2];
  rows->r3 = from[at.s3];
  rows->r4 = from[at.s4];
  rows->r5 = from[at.s5];
  rows->r6 = from[at.s6];
  rows->r7 = from[at.s7];
}

#define CLPV_COLUMN(rows, c)                                                                           \
  ((float8)((rows).r0.c, (rows).r1.c, (rows).r2.c, (rows).r3.c, (rows).r4.c, (rows).r5.c, (rows).r6.c, \
            (rows).r7.c))

// Whether a comparison holds in no lane.
static inline bool none(const int8 lanes) {
  const long4 pairs = as_long4(lanes);
  return (pairs.x | pairs.y | pairs.z | pairs.w) == 0;
}

// A comparison as bits, one a lane, the first the lowest.
static inline uint clpv_bits(const int8 lanes) {
  const int8 bits = lanes & (int8)(1, 2, 4, 8, 16, 32, 64, 128);
  const int4 four = bits.lo | bits.hi;
  return (uint)(four.x | four.y | four.z | four.w);
}

// PoCL leaves large functions out of line.
#define CLPV_INLINE static inline __attribute__((always_inline))

#endif
