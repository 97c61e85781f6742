// SPDX-License-Identifier: MIT
// Zeroes a buffer: where the device's own fill will not do (Session::fill_zero says where).
__kernel void zero(__global uint* words, const uint count) {
  const uint i = get_global_id(0);
  if (i < count) words[i] = 0;
}
