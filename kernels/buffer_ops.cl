// SPDX-License-Identifier: MIT
// Zeroes and copies ranges of uint32 words in buffers, on devices whose fill and copy commands fail
// (Session::fill_zero, Session::copy).
//
//   zero   words[first .. first + count) = 0
//   copy   to[first .. first + count) = from[0 .. count)
//
// A work-item processes a word.
__kernel void zero(__global uint* words, const uint first, const uint count) {
  const uint i = get_global_id(0);
  if (i < count) words[first + i] = 0;
}

__kernel void copy(__global const uint* from, __global uint* to, const uint first,
                   const uint count) {
  const uint i = get_global_id(0);
  if (i < count) to[first + i] = from[i];
}
