// SPDX-License-Identifier: MIT
// Zeroes an image: for GPUs, where the host may wait milliseconds for a fill of one.
// A work-item writes a texel.
#define CLPV_LAYOUT 3  // CLPV_IMAGE
#include "lanes.h"
#include "volume/layouts.h"

__kernel void zero_image(__write_only image3d_t image) {
  const int4 at = (int4)(get_global_id(0), get_global_id(1), get_global_id(2), 0);
  if (at.x < get_image_width(image)) write_imagef(image, at, (float4)(0.0f));
}
