// SPDX-License-Identifier: MIT
// Template of the volume types: load and store in the layout and storage that the host chooses
// (layouts.h).
//
// Define these parameters before each inclusion; this file undefines them at its end
//   CLPV_VOLUME         prefix of the functions below (light, geometry, ...)
//   CLPV_VOLUME_N       samples along each axis, a literal
//   CLPV_VOLUME_CELL    struct with an array c of the numbers of a sample and channel, and
//                       CLPV_VOLUME_COUNT, number of them
// It defines
//   CELL NAME_load(in, channel, x, y, z)               x, y, z in -1..n; the border is 0
//   void NAME_store(out, channel, x, y, z, cell)       x, y, z in 0..n-1
// A cell is W cells along x. With 8 lanes, x is a multiple of 8 in stores; lanes beyond the border
// load undefined values and are not stored. Every layout has a border of zeros, so that a neighbour
// outside the grid reads 0 without a test.
#include "volume/layouts.h"

#if CLPV_LAYOUT == CLPV_IMAGE
#include "volume/image.h"
#else
#if CLPV_LAYOUT == CLPV_AOS
#include "volume/aos.h"
#elif CLPV_LAYOUT == CLPV_TILED
#include "volume/tiled.h"
#elif CLPV_LAYOUT == CLPV_SOA
#include "volume/soa.h"
#endif
#include "volume/buffer.h"
#endif

#undef CLPV_VOLUME
#undef CLPV_VOLUME_N
#undef CLPV_VOLUME_CELL
#undef CLPV_VOLUME_COUNT
