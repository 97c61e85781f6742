// SPDX-License-Identifier: MIT
// How buffers hold numbers: float, or half. Half is loaded and stored by the functions core OpenCL C 1.2 has for it.
#ifndef CLPV_VOLUME_NUMBERS_H
#define CLPV_VOLUME_NUMBERS_H

#if CLPV_STORAGE_HALF
#define CLPV_NUMBER half
#define CLPV_READ(from, at) vload_half(0, (from) + (at))
#define CLPV_WRITE(to, at, value) vstore_half(value, 0, (to) + (at))
#define CLPV_READ_ROW(from, at) clpv_read_row((from) + (at))
#define CLPV_WRITE_ROW(to, at, value) clpv_write_row((to) + (at), value)
#else
#define CLPV_NUMBER float
#define CLPV_READ(from, at) (from)[at]
#define CLPV_WRITE(to, at, value) (to)[at] = value
#define CLPV_READ_ROW(from, at) vload8(0, (from) + (at))
#define CLPV_WRITE_ROW(to, at, value) vstore8(value, 0, (to) + (at))
#endif

#if CLPV_STORAGE_HALF
// Rows begin at any half. PoCL 3.1 takes 16-byte alignment for granted in vload_half8 and vstore_half8, and crashes where a
// converted row is stored by itself: so conversion is to and from a vector of one's own, and what is loaded and stored is
// of a type that may stand at any half.
typedef struct __attribute__((packed, aligned(2))) {
  ushort8 bits;
} HalfRow;
static inline __attribute__((always_inline)) float8 clpv_read_row(__global const half* from) {
  const ushort8 bits = ((__global const HalfRow*)from)->bits;
  return vload_half8(0, (const half*)&bits);
}
static inline __attribute__((always_inline)) void clpv_write_row(__global half* to, const float8 value) {
  ushort8 bits;
  vstore_half8(value, 0, (half*)&bits);
  ((__global HalfRow*)to)->bits = bits;
}
#endif

#define CLPV_BUFFER_IN __global const CLPV_NUMBER*
#define CLPV_BUFFER_OUT __global CLPV_NUMBER*

#endif
