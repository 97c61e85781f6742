// SPDX-License-Identifier: MIT
// Reports the layout of the structs that device and host share, for `clpv check`: sizes and offsets
// of members.
//
// Out:  bytes  size of the struct and offset of the member for each FIELD of CLPV_EACH_SHARED
//              (shared/fields.h), in its order [bytes]
// A single work-item.
#include "shared/emit.h"
#include "shared/fields.h"
#include "shared/grid.h"
#include "shared/light.h"
#include "shared/mesh.h"
#include "shared/raster.h"
#include "shared/region.h"
#include "shared/sweep.h"
#include "shared/view.h"
#include "shared/view_injection.h"
#include "shared/view_light.h"

__kernel void sizes(__global uint* bytes) {
  if (get_global_id(0) != 0) return;
  uint i = 0;
#define CLPV_FIELD(type, field)                                                                 \
  {                                                                                             \
    type value;                                                                                 \
    bytes[i++] = (uint)sizeof(type);                                                            \
    bytes[i++] = (uint)((__private const uchar*)&value.field - (__private const uchar*)&value); \
  }
  CLPV_EACH_SHARED(CLPV_FIELD)
}
