// SPDX-License-Identifier: MIT
// Zeroes a part of a buffer: where the device's own fill will not do (Session::fill_zero says where).
__kernel void zero(__global uint* words, const uint first, const uint count) {
  const uint i = get_global_id(0);
  if (i < count) words[first + i] = 0;
}
