// SPDX-License-Identifier: MIT
// Vectors of W lanes: pixels of a row, cells of a row, triangles, rays. All files that use lanes
// include it.
//
// W 8 is for CPUs; inner loops with it call no function that PoCL does not inline, such as any(),
// floor() or log2(). W 1 is for GPUs, whose hardware runs work-items in lanes, and for kernels on
// images. On CPUs, PoCL vectorises the work-items of a W 1 kernel only in short kernels of
// straight-line code, without branches (volume/whole_groups.h).
#pragma once

#ifndef CLPV_W
#define CLPV_W 8
#endif
#define W CLPV_W

// Large functions need the attribute: PoCL leaves them out of line.
#define CLPV_INLINE static inline __attribute__((always_inline))

// For functions that seldom run. CPUs: not inlined, to leave registers to the common path. GPUs:
// inlined, since calls keep their stack in scratch memory.
#if W == 1
#define CLPV_OUT_OF_LINE_ON_CPUS CLPV_INLINE
#else
#define CLPV_OUT_OF_LINE_ON_CPUS __attribute__((noinline))
#endif

// Vectors of W numbers, conversions between them, and load and store of W numbers that follow one
// another. A comparison of vectors is a mask: an intW, -1 where it holds and 0 elsewhere. With one
// lane it is 1 or 0. Negate masks by `mask == 0`, not ~mask, and call all_bits(mask) before
// combining it with other integers.
#if W == 8
#define CLPV_VECTOR(name) name##8
#define to_intW_rte convert_int8_rte
#define to_uintW_rte convert_uint8_rte
#define load_lanes(from) vload8(0, from)
#define store_lanes(value, to) vstore8(value, 0, to)
#define first_lane(value) ((value).s0)
// Gathers one element per lane, at the indices `at`; `member`: empty, or a member of the elements
// (.flags).
#define CLPV_GATHER_MEMBER(from, at, member)                                                       \
  ((from)[(at).s0] member, (from)[(at).s1] member, (from)[(at).s2] member, (from)[(at).s3] member, \
   (from)[(at).s4] member, (from)[(at).s5] member, (from)[(at).s6] member, (from)[(at).s7] member)
#else
#define CLPV_VECTOR(name) name
#define to_intW_rte convert_int_rte
#define to_uintW_rte convert_uint_rte
#define load_lanes(from) (*(from))
#define store_lanes(value, to) (*(to) = (value))
#define first_lane(value) (value)
#define CLPV_GATHER_MEMBER(from, at, member) ((from)[at] member)
#endif
typedef CLPV_VECTOR(float) realW;
typedef CLPV_VECTOR(int) intW;
typedef CLPV_VECTOR(uint) uintW;
typedef CLPV_VECTOR(long) longW;
typedef CLPV_VECTOR(uchar) bytesW;
#define to_realW CLPV_VECTOR(convert_float)
#define to_intW CLPV_VECTOR(convert_int)
#define to_uintW CLPV_VECTOR(convert_uint)
#define to_longW CLPV_VECTOR(convert_long)
#define to_bytesW CLPV_VECTOR(convert_uchar)
#define as_realW CLPV_VECTOR(as_float)
#define as_intW CLPV_VECTOR(as_int)
#define as_uintW CLPV_VECTOR(as_uint)
#define CLPV_GATHER(from, at) CLPV_GATHER_MEMBER(from, at, )

#define ZERO ((realW)(0.0f))
#define ONE ((realW)(1.0f))

// One float4 per lane, loaded whole: one load per lane instead of four. CLPV_COLUMN takes one
// component of all lanes. Functions that read buffers return structs through pointers: Oclgrind
// does not know the annotations that compilers give to functions that return one.
typedef struct {
  float4 row[W];
} Rows;

CLPV_INLINE void gather_rows(__global const float4* from, const uintW at, Rows* rows) {
#pragma unroll
  for (int i = 0; i < W; ++i) rows->row[i] = from[((const uint*)&at)[i]];
}

// Loads one float4 for all lanes.
CLPV_INLINE void spread_row(__global const float4* from, const uint at, Rows* rows) {
#pragma unroll
  for (int i = 0; i < W; ++i) rows->row[i] = from[at];
}

#if W == 8

#define CLPV_COLUMN(rows, c)                                                               \
  ((realW)((rows).row[0].c, (rows).row[1].c, (rows).row[2].c, (rows).row[3].c,             \
           (rows).row[4].c, (rows).row[5].c, (rows).row[6].c, (rows).row[7].c))

// 0 to W - 1.
static inline intW lane_numbers(void) { return (int8)(0, 1, 2, 3, 4, 5, 6, 7); }
static inline intW all_bits(const intW mask) { return mask; }

// Returns true if a mask holds in no lane.
static inline bool no_lane(const intW mask) {
  return as_long(convert_char8(mask)) == 0;
}

// Bits of a mask; the first lane is the lowest bit.
static inline uint lane_bits(const intW mask) {
  return (uint)(((as_ulong(convert_char8(mask)) & 0x0101010101010101ul) * 0x0102040810204080ul) >>
                56);
}

// Sums and extremes over all lanes.
static inline float sum_lanes(const realW v) {
  const float4 four = v.lo + v.hi;
  return four.x + four.y + four.z + four.w;
}
static inline uint sum_lanes_uint(const uintW v) {
  const uint4 four = v.lo + v.hi;
  return four.x + four.y + four.z + four.w;
}
static inline float min_lane(const realW v) {
  const float4 four = v.lo < v.hi ? v.lo : v.hi;
  const float2 two = four.lo < four.hi ? four.lo : four.hi;
  return two.x < two.y ? two.x : two.y;
}
static inline int min_lane_int(const intW v) {
  const int4 four = min(v.lo, v.hi);
  return min(min(four.x, four.y), min(four.z, four.w));
}
static inline int max_lane_int(const intW v) {
  return -min_lane_int(-v);
}

#else

#define CLPV_COLUMN(rows, c) ((rows).row[0].c)

static inline intW lane_numbers(void) { return 0; }
static inline intW all_bits(const intW mask) { return mask ? -1 : 0; }

static inline bool no_lane(const intW mask) {
  return mask == 0;
}
static inline uint lane_bits(const intW mask) {
  return mask ? 1u : 0u;
}
static inline float sum_lanes(const realW v) {
  return v;
}
static inline uint sum_lanes_uint(const uintW v) {
  return v;
}
static inline float min_lane(const realW v) {
  return v;
}
static inline int min_lane_int(const intW v) {
  return v;
}
static inline int max_lane_int(const intW v) {
  return v;
}

#endif
