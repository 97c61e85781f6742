// SPDX-License-Identifier: MIT
// An image layout's volume to planes in a buffer and back, for stages that change a few cells in place: OpenCL 1.2 has
// kernels either read an image or write it.
//
// From the host: CLPV_GRID, samples along each axis; the coefficients' macros. A work-item is a sample of a channel;
// channels are stacked along z. CLPV_LAYOUT is CLPV_IMAGE; planes are of the same storage.
#include "volume/light.h"
#include "volume/numbers.h"

#define CLPV_VOLUME planes
#define CLPV_VOLUME_N CLPV_GRID
#define CLPV_VOLUME_CELL Coefficients
#define CLPV_VOLUME_EACH CLPV_EACH_COEFFICIENT
#define CLPV_VOLUME_COUNT CLPV_N
#include "volume/soa.h"
#include "volume/buffer.h"

__kernel void image_to_planes(CLPV_IMAGE_IN image, CLPV_BUFFER_OUT planes) {
  const int x = get_global_id(0), y = get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  planes_store(planes, channel, x, y, z, light_load(image, channel, x, y, z));
}

__kernel void planes_to_image(CLPV_BUFFER_IN planes, CLPV_IMAGE_OUT image) {
  const int x = get_global_id(0), y = get_global_id(1);
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID;
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;
  light_store(image, channel, x, y, z, planes_load(planes, channel, x, y, z));
}
