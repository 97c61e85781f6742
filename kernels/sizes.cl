// SPDX-License-Identifier: MIT
// Reports the layout of the structs that device and host share, for `clpv check`: sizes and offsets of members.
//
// Out:  bytes  one number per SIZE and OFFSET of CLPV_EACH_SHARED (shared/fields.h), in its order [bytes]
// A single work-item.
#include "shared/emit.h"
#include "shared/fields.h"
#include "shared/grid.h"
#include "shared/light.h"
#include "shared/mesh.h"
#include "shared/region.h"
#include "shared/sweep.h"
#include "shared/view.h"

// Compilation fails if a size differs from the one that the host asserts.
#define CLPV_ASSERT_SIZE(type, bytes) typedef char assert_##type[sizeof(type) == bytes ? 1 : -1];
CLPV_ASSERT_SIZE(ClpvGrid, CLPV_SIZEOF_GRID)
CLPV_ASSERT_SIZE(ClpvMedium, CLPV_SIZEOF_MEDIUM)
CLPV_ASSERT_SIZE(ClpvLight, CLPV_SIZEOF_LIGHT)
CLPV_ASSERT_SIZE(ClpvVertex, CLPV_SIZEOF_VERTEX)
CLPV_ASSERT_SIZE(ClpvTriangle, CLPV_SIZEOF_TRIANGLE)
CLPV_ASSERT_SIZE(ClpvMaterial, CLPV_SIZEOF_MATERIAL)
CLPV_ASSERT_SIZE(ClpvTexture, CLPV_SIZEOF_TEXTURE)
CLPV_ASSERT_SIZE(ClpvEmitter, CLPV_SIZEOF_EMITTER)
CLPV_ASSERT_SIZE(ClpvView, CLPV_SIZEOF_VIEW)
CLPV_ASSERT_SIZE(ClpvSweepBin, CLPV_SIZEOF_SWEEP_BIN)
CLPV_ASSERT_SIZE(ClpvSweepDirection, CLPV_SIZEOF_SWEEP_DIRECTION)
CLPV_ASSERT_SIZE(ClpvSweepHalo, CLPV_SIZEOF_SWEEP_HALO)
CLPV_ASSERT_SIZE(ClpvRegion, CLPV_SIZEOF_REGION)

__kernel void sizes(__global uint* bytes) {
  if (get_global_id(0) != 0) return;
  uint i = 0;
#define CLPV_SIZE(type) bytes[i++] = (uint)sizeof(type);
#define CLPV_OFFSET(type, field)                                                                \
  {                                                                                             \
    type value;                                                                                 \
    bytes[i++] = (uint)((__private const uchar*)&value.field - (__private const uchar*)&value); \
  }
  CLPV_EACH_SHARED(CLPV_SIZE, CLPV_OFFSET)
}
