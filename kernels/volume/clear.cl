// SPDX-License-Identifier: MIT
// Zeroes a 3-D image of a volume: a work-item a texel.
#pragma OPENCL EXTENSION cl_khr_3d_image_writes : enable

__kernel void clear(__write_only image3d_t image) {
  const int4 at = (int4)(get_global_id(0), get_global_id(1), get_global_id(2), 0);
  if (any(at.xyz >= get_image_dim(image).xyz)) return;
  write_imagef(image, at, (float4)(0.0f));
}
