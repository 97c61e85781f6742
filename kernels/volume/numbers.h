// SPDX-License-Identifier: MIT
// Storage of numbers in buffers: float or half. Halves are converted by core OpenCL C 1.2, always eight at a time: PoCL
// 3.1 has one instruction for eight, and 1,900 for a single one.
#pragma once

#include "lanes.h"

#if CLPV_STORAGE_HALF
#define CLPV_NUMBER half
#define CLPV_READ(from, at) halves_to_floats((ushort8)(((__global const ushort*)(from))[at])).s0
#define CLPV_WRITE(to, at, value) ((__global ushort*)(to))[at] = floats_to_halves((float8)(value)).s0
#define CLPV_READ_ROW(from, at) read_halves((from) + (at))
#define CLPV_WRITE_ROW(to, at, value) write_halves((to) + (at), value)
#else
#define CLPV_NUMBER float
#define CLPV_READ(from, at) (from)[at]
#define CLPV_WRITE(to, at, value) (to)[at] = value
#define CLPV_READ_ROW(from, at) vload8(0, (from) + (at))
#define CLPV_WRITE_ROW(to, at, value) vstore8(value, 0, (to) + (at))
#endif

#if CLPV_STORAGE_HALF
// Conversion through a private vector: PoCL 3.1 assumes 16-byte alignment in vload_half8 and vstore_half8.
CLPV_INLINE float8 halves_to_floats(const ushort8 bits) {
  return vload_half8(0, (const half*)&bits);
}
CLPV_INLINE ushort8 floats_to_halves(const float8 values) {
  ushort8 bits;
  vstore_half8(values, 0, (half*)&bits);
  return bits;
}
// Rows start at any half, hence a type of alignment 2; storing the converted vector itself crashes.
typedef struct __attribute__((packed, aligned(2))) {
  ushort8 bits;
} HalfRow;
CLPV_INLINE float8 read_halves(__global const half* from) {
  return halves_to_floats(((__global const HalfRow*)from)->bits);
}
CLPV_INLINE void write_halves(__global half* to, const float8 value) {
  ((__global HalfRow*)to)->bits = floats_to_halves(value);
}
#endif

#define CLPV_BUFFER_IN __global const CLPV_NUMBER*
#define CLPV_BUFFER_OUT __global CLPV_NUMBER*
