// SPDX-License-Identifier: MIT
// Sums over the sorted texels of each cell, by segments: up to `length` texels of a cell, counted
// from the cell's first texel. A cell's sum depends only on its own texels, bit by bit. Part of
// light.cl and surfels.cl, whose kernel sum_segments calls sum_block:
//
//   sum_block       sums of the segments that start in a block
//   join_segments   sums of the cells that have several segments: the kernel of both files
//
// The file that includes this one defines
//   CLPV_CHANNELS                              number of sums of a cell
//   CLPV_KEYS                                  number of keys of a surface
//   Texels                                     struct of the texels' buffers, with `surface`:
//                                              ClpvInjection of the texels' surface, and its index
//   Sums add_texel(sums, texel, texels)        adds a texel to a cell's sums
//   void deliver(volume, key, sums)            adds a cell's sums to the volume
#pragma once

#define CLPV_NO_SEGMENT 0xffffffffu

static inline Sums no_sums(void) {
  Sums sums;
#pragma unroll
  for (int c = 0; c < CLPV_CHANNELS; ++c) sums.channel[c] = zero_coefficients();
  return sums;
}

static inline void store_sums(__global float* partials, const uint slot, const Sums sums) {
  __global float* to = partials + slot * (CLPV_CHANNELS * CLPV_N);
#pragma unroll
  for (int c = 0; c < CLPV_CHANNELS; ++c) {
#pragma unroll
    for (int i = 0; i < CLPV_N; ++i) to[c * CLPV_N + i] = sums.channel[c].c[i];
  }
}

static inline Sums add_stored(Sums sums, __global const float* partials, const uint slot) {
  __global const float* from = partials + slot * (CLPV_CHANNELS * CLPV_N);
#pragma unroll
  for (int c = 0; c < CLPV_CHANNELS; ++c) {
#pragma unroll
    for (int i = 0; i < CLPV_N; ++i) sums.channel[c].c[i] += from[c * CLPV_N + i];
  }
  return sums;
}

// Index of the first sorted texel of cell `key`, by binary search in [0, before]. Texel `before`
// belongs to the cell.
static inline uint first_of_cell(__global const uint2* sorted, const uint key, const uint before) {
  uint low = 0, high = before;
  while (low < high) {
    const uint middle = low + (high - low) / 2;
    if (sorted[middle].x < key) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

// Index at which the first segment of a block starts: where a cell starts, or a whole number of
// segments later.
static inline uint first_segment(__global const uint2* sorted, const uint total, const uint length,
                                 const uint block, bool* starts_cell) {
  uint at = block * length;
  const uint key = sorted[at].x;
  *starts_cell = true;
  if (at == 0 || sorted[at - 1].x != key) return at;
  const uint begin = first_of_cell(sorted, key, at);
  const uint boundary = begin + (at - begin + length - 1) / length * length;
  while (at < boundary && at < total && sorted[at].x == key) ++at;
  *starts_cell = !(at == boundary && at < total && sorted[at].x == key);
  return at;
}

// Sums the segments that start in a block of `length` sorted texels; a work-item per block. A cell
// of one segment is delivered at once. For a longer cell that starts in the block, firsts[block] is
// the index of its first texel, partials[2 block + 1] its first segment's sums. partials[2 block]:
// sums of a later segment of a cell that starts in an earlier block. A block has at most one of
// each.
CLPV_INLINE void sum_block(__global const ClpvInjection* injections, __global const uint2* sorted,
                           __global const uint* count, const uint length, const uint blocks,
                           Texels texels, CLPV_VOLUME_OUT volume, __global float* partials,
                           __global uint* firsts CLPV_AND_H) {
  const uint block = get_global_id(0);
  if (block >= blocks) return;
  firsts[block] = CLPV_NO_SEGMENT;
  const uint total = count[0];
  const uint stop = min((block + 1) * length, total);
  if (block * length >= stop) return;
  bool starts_cell;
  uint at = first_segment(sorted, total, length, block, &starts_cell);
  while (at < stop) {
    const uint key = sorted[at].x;
    const uint first = at, end = min(at + length, total);
    Sums sums = no_sums();
    texels.number = key / CLPV_KEYS, texels.surface = injections + texels.number;
    for (; at < end && sorted[at].x == key; ++at)
      sums = add_texel(sums, sorted[at].y, texels CLPV_PASS_H);
    const bool ends_cell = at == total || sorted[at].x != key;
    if (starts_cell && ends_cell) {
      deliver(volume + texels.surface->volume, key % CLPV_KEYS, sums);
    } else {
      store_sums(partials, 2 * block + (starts_cell ? 1 : 0), sums);
      if (starts_cell) firsts[block] = first;
    }
    starts_cell = true;
  }
}

// Delivers the cells of several segments; a work-item per block, for the cell whose first segment
// starts in it.
__kernel void join_segments(__global const ClpvInjection* injections, __global const uint2* sorted,
                            __global const uint* count, const uint length, const uint blocks,
                            CLPV_VOLUME_OUT volume, __global const float* partials,
                            __global const uint* firsts) {
  const uint block = get_global_id(0);
  if (block >= blocks) return;
  uint at = firsts[block];
  if (at == CLPV_NO_SEGMENT) return;
  const uint key = sorted[at].x, total = count[0];
  Sums sums = add_stored(no_sums(), partials, 2 * block + 1);
  uint slot = 2 * block + 2;
  for (at += length; at < total && sorted[at].x == key; at += length, slot += 2) {
    sums = add_stored(sums, partials, slot);
  }
  deliver(volume + injections[key / CLPV_KEYS].volume, key % CLPV_KEYS, sums);
}
