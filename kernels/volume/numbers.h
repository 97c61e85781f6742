// SPDX-License-Identifier: MIT
// How buffers hold numbers: float, or half. Half is loaded and stored by the functions core OpenCL C 1.2 has for it.
#ifndef CLPV_VOLUME_NUMBERS_H
#define CLPV_VOLUME_NUMBERS_H

#if CLPV_STORAGE_HALF
#define CLPV_NUMBER half
#define CLPV_READ(from, at) vload_half(0, (from) + (at))
#define CLPV_WRITE(to, at, value) vstore_half(value, 0, (to) + (at))
#define CLPV_READ_ROW(from, at) vload_half8(0, (from) + (at))
#define CLPV_WRITE_ROW(to, at, value) vstore_half8(value, 0, (to) + (at))
#else
#define CLPV_NUMBER float
#define CLPV_READ(from, at) (from)[at]
#define CLPV_WRITE(to, at, value) (to)[at] = value
#define CLPV_READ_ROW(from, at) vload8(0, (from) + (at))
#define CLPV_WRITE_ROW(to, at, value) vstore8(value, 0, (to) + (at))
#endif

#define CLPV_BUFFER_IN __global const CLPV_NUMBER*
#define CLPV_BUFFER_OUT __global CLPV_NUMBER*

#endif
