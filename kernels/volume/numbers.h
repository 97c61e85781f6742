// SPDX-License-Identifier: MIT
// Storage of numbers in buffers: float or half. Halves are converted by core OpenCL C 1.2, always
// eight at a time: PoCL 3.1 has one instruction for eight, and 1,900 for a single one.
#pragma once

#include "lanes.h"

#if CLPV_STORAGE_HALF
#define CLPV_BUFFER_IN __global const half*
#define CLPV_BUFFER_OUT __global half*

// Conversion through a private vector: PoCL 3.1 assumes 16-byte alignment in vload_half8 and
// vstore_half8.
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

// W numbers after a store and a load.
CLPV_INLINE realW stored_numbers(const realW values) {
  const float8 eight = halves_to_floats(floats_to_halves((float8)(values)));
  return *(const realW*)&eight;
}
CLPV_INLINE float read_number(CLPV_BUFFER_IN from, const int at) {
  return halves_to_floats((ushort8)(((__global const ushort*)from)[at])).s0;
}
CLPV_INLINE void write_number(CLPV_BUFFER_OUT to, const int at, const float value) {
  ((__global ushort*)to)[at] = floats_to_halves((float8)(value)).s0;
}
CLPV_INLINE float8 read_eight(CLPV_BUFFER_IN from, const int at) {
  return halves_to_floats(((__global const HalfRow*)(from + at))->bits);
}
CLPV_INLINE void write_eight(CLPV_BUFFER_OUT to, const int at, const float8 value) {
  ((__global HalfRow*)(to + at))->bits = floats_to_halves(value);
}
#else
#define CLPV_BUFFER_IN __global const float*
#define CLPV_BUFFER_OUT __global float*

CLPV_INLINE realW stored_numbers(const realW values) { return values; }
CLPV_INLINE float read_number(CLPV_BUFFER_IN from, const int at) { return from[at]; }
CLPV_INLINE void write_number(CLPV_BUFFER_OUT to, const int at, const float value) {
  to[at] = value;
}
CLPV_INLINE float8 read_eight(CLPV_BUFFER_IN from, const int at) { return vload8(0, from + at); }
CLPV_INLINE void write_eight(CLPV_BUFFER_OUT to, const int at, const float8 value) {
  vstore8(value, 0, to + at);
}
#endif

// W numbers from index `at` on.
#if W == 8
#define read_numbers read_eight
#define write_numbers write_eight
#else
#define read_numbers read_number
#define write_numbers write_number
#endif
