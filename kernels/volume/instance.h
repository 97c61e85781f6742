// SPDX-License-Identifier: MIT
// Template of the volume types: load and store in the layout and storage that the host chooses.
//
// Literals: CLPV_LAYOUT, one of the four names below; CLPV_STORAGE_HALF 1: numbers of 16 bits, with arithmetic in
// single precision; W: cells along x of a load or store, 1 or 8.
//
// Parameters: define before each inclusion, which undefines them
//   CLPV_VOLUME         prefix of the functions below (light, geometry, ...)
//   CLPV_VOLUME_N       samples along each axis, a literal
//   CLPV_VOLUME_CELL    struct with an array c of the numbers of a sample and channel
//   CLPV_VOLUME_COUNT   number of them
// It defines
//   CLPV_VOLUME_IN, CLPV_VOLUME_OUT                    types of kernel parameters that read, write
//   CELL NAME_load(in, channel, x, y, z)               x, y, z in -1..n; the border is 0
//   void NAME_store(out, channel, x, y, z, cell)       x, y, z in 0..n-1
// With 8 lanes, x is a multiple of 8 in stores; lanes beyond the border load undefined values and are not stored. Every
// layout has a border of zeros, so that a neighbour outside the grid reads 0 without a test.
#ifndef CLPV_VOLUME_INSTANCE_ONCE
#define CLPV_VOLUME_INSTANCE_ONCE

#define CLPV_SOA 0
#define CLPV_AOS 1
#define CLPV_TILED 2
#define CLPV_IMAGE 3
#ifndef CLPV_LAYOUT
#define CLPV_LAYOUT CLPV_SOA
#endif
#ifndef CLPV_STORAGE_HALF
#define CLPV_STORAGE_HALF 0
#endif

#define CLPV_PASTE2(a, b) a##_##b
#define CLPV_PASTE(a, b) CLPV_PASTE2(a, b)
#endif

#if CLPV_LAYOUT == CLPV_IMAGE
#include "volume/image.h"
#define CLPV_VOLUME_IN CLPV_IMAGE_IN
#define CLPV_VOLUME_OUT CLPV_IMAGE_OUT
#else
#include "volume/numbers.h"
#define CLPV_VOLUME_IN CLPV_BUFFER_IN
#define CLPV_VOLUME_OUT CLPV_BUFFER_OUT
#if CLPV_LAYOUT == CLPV_AOS
#include "volume/aos.h"
#elif CLPV_LAYOUT == CLPV_TILED
#include "volume/tiled.h"
#else
#include "volume/soa.h"
#endif
#include "volume/buffer.h"
#endif

#undef CLPV_VOLUME
#undef CLPV_VOLUME_N
#undef CLPV_VOLUME_CELL
#undef CLPV_VOLUME_COUNT
