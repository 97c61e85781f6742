// SPDX-License-Identifier: MIT
// Explicit vectors of eight lanes, such as eight pixels of a row.
//
// PoCL vectorises work-items in short kernels of straight-line code on named scalars, without arrays, branches and
// float3 in memory (coefficients.h, surface.h, volume/whole_groups.h). Longer kernels use float8, and no function that
// PoCL does not inline, such as any(), floor() or log2().
#ifndef CLPV_LANES_H
#define CLPV_LANES_H

#define CLPV_ABREAST 8
#define CLPV_COMPONENT float8

// Gathers one element per lane, at the indices `at`.
#define CLPV_GATHER(from, at)                                                                            \
  ((from)[(at).s0], (from)[(at).s1], (from)[(at).s2], (from)[(at).s3], (from)[(at).s4], (from)[(at).s5], \
   (from)[(at).s6], (from)[(at).s7])

// Gathers a float4 per lane, then reads it by columns: one load per lane instead of four.
typedef struct {
  float4 r0, r1, r2, r3, r4, r5, r6, r7;
} Rows;

// Functions that read buffers return structs through pointers: Oclgrind does not know the annotations that compilers
// give to functions that return one.
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

// Returns true if a comparison holds in no lane.
static inline bool none(const int8 lanes) {
  return as_long(convert_char8(lanes)) == 0;
}

// Bit mask of a comparison; the first lane is the lowest bit.
static inline uint clpv_bits(const int8 lanes) {
  return (uint)(((as_ulong(convert_char8(lanes)) & 0x0101010101010101ul) * 0x0102040810204080ul) >> 56);
}

// Large functions need the attribute: PoCL leaves them out of line.
#define CLPV_INLINE static inline __attribute__((always_inline))

#endif
