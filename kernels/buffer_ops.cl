// SPDX-License-Identifier: MIT
// Zeroes, or copies into, a part of a buffer: where the device's own commands will not do (Session::fill_by_kernel says where).
__kernel void zero(__global uint* words, const uint first, const uint count) {
  const uint i = get_global_id(0);
  if (i < count) words[first + i] = 0;
}

__kernel void copy(__global const uint* from, __global uint* to, const uint first, const uint count) {
  const uint i = get_global_id(0);
  if (i < count) to[first + i] = from[i];
}
