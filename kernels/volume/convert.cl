// SPDX-License-Identifier: MIT
// Converts a volume between an image and planes in a buffer (layout soa), for stages that change a
// few cells in place: in OpenCL 1.2 a kernel either reads or writes an image.
//
//   image_to_planes    planes = image
//   planes_to_image    image = planes
//
// Both have the same storage, CLPV_GRID^3 samples and three channels or one. A work-item converts a
// sample of a channel; channels are stacked along z. CLPV_LAYOUT is CLPV_IMAGE.
#include "volume/light.h"
#include "volume/numbers.h"

#define CLPV_VOLUME planes
#define CLPV_VOLUME_N CLPV_GRID
#define CLPV_VOLUME_CELL Coefficients
#define CLPV_VOLUME_COUNT CLPV_N
#include "volume/soa.h"
#include "volume/buffer.h"

__kernel void image_to_planes(__read_only image3d_t image, CLPV_BUFFER_OUT planes) {
  const int x = get_global_id(0), y = get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  planes_store(planes, channel, x, y, z, light_load(image, channel, x, y, z));
}

__kernel void planes_to_image(CLPV_BUFFER_IN planes, __write_only image3d_t image) {
  const int x = get_global_id(0), y = get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  light_store(image, channel, x, y, z, planes_load(planes, channel, x, y, z));
}
