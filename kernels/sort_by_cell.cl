// SPDX-License-Identifier: MIT
// Sorts the texels of a surface by the cell they fall into, keeping their order within a cell: the deterministic
// way to let one work-item sum all that a cell receives, with no atomics.
//
// In: one key a texel, its cell's number or CLPV_NO_CELL. Out: (key, texel) of every other texel, and how many.
//
// A radix sort of two passes, low digit and high digit, each counting, adding up and scattering by chunks that keep
// their order. Neighbouring texels mostly fall into one cell: the first pass gathers them into runs, which are a
// fraction of the texels, and the second takes the runs apart again.
//
// counts[digit][chunk]: how many a chunk has of a digit, then where its first of them goes. Zeroed by the host.
#include "shared/sort.h"

// Runs start where the key changes, and at every multiple of CLPV_LONGEST_RUN.
static inline bool starts_run(const uint texel, const uint key, const uint previous) {
  return key != CLPV_NO_CELL && (key != previous || texel % CLPV_LONGEST_RUN == 0);
}

static inline uint run_length(__global const uint* keys, const uint texels, const uint first, const uint key) {
  const uint stop = min(texels, first - first % CLPV_LONGEST_RUN + CLPV_LONGEST_RUN);
  uint end = first + 1;
  while (end < stop && keys[end] == key) ++end;
  return end - first;
}

// First pass, counting: one work-item a chunk of `chunk` texels, a multiple of CLPV_LONGEST_RUN.
__kernel void count_runs(__global const uint* keys, const uint texels, const uint chunk, const uint chunks,
                         const uint low_bits, __global uint* counts) {
  const uint c = get_global_id(0);
  if (c >= chunks) return;
  const uint last = min((c + 1) * chunk, texels);
  const uint mask = (1u << low_bits) - 1u;
  uint previous = CLPV_NO_CELL;
  for (uint texel = c * chunk; texel < last; ++texel) {
    const uint key = keys[texel];
    if (starts_run(texel, key, previous)) ++counts[(key & mask) * chunks + c];
    previous = key;
  }
}

// First pass, scattering: runs[2 i] the key, runs[2 i + 1] first texel and length. (Storing both as a uint2 makes
// Oclgrind 21.10 report a fault that is none.)
__kernel void scatter_runs(__global const uint* keys, const uint texels, const uint chunk, const uint chunks,
                           const uint low_bits, __global uint* counts, __global uint* runs) {
  const uint c = get_global_id(0);
  if (c >= chunks) return;
  const uint last = min((c + 1) * chunk, texels);
  const uint mask = (1u << low_bits) - 1u;
  uint previous = CLPV_NO_CELL;
  for (uint texel = c * chunk; texel < last; ++texel) {
    const uint key = keys[texel];
    if (starts_run(texel, key, previous)) {
      const uint to = counts[(key & mask) * chunks + c]++;
      runs[2 * to] = key;
      runs[2 * to + 1] = texel << CLPV_RUN_BITS | (run_length(keys, texels, texel, key) - 1);
    }
    previous = key;
  }
}

// Second pass, counting texels: one work-item a chunk of `chunk` runs.
__kernel void count_texels(__global const uint* runs, __global const uint* run_count, const uint chunk,
                           const uint chunks, const uint low_bits, __global uint* counts) {
  const uint c = get_global_id(0);
  if (c >= chunks) return;
  const uint last = min((c + 1) * chunk, run_count[0]);
  for (uint i = c * chunk; i < last; ++i) {
    counts[(runs[2 * i] >> low_bits) * chunks + c] += runs[2 * i + 1] % CLPV_LONGEST_RUN + 1;
  }
}

// Second pass, scattering: sorted[2 i] the key, sorted[2 i + 1] the texel.
__kernel void scatter_texels(__global const uint* runs, __global const uint* run_count, const uint chunk,
                             const uint chunks, const uint low_bits, __global uint* counts,
                             __global uint* sorted) {
  const uint c = get_global_id(0);
  if (c >= chunks) return;
  const uint last = min((c + 1) * chunk, run_count[0]);
  for (uint i = c * chunk; i < last; ++i) {
    const uint key = runs[2 * i], run = runs[2 * i + 1];
    const uint first = run >> CLPV_RUN_BITS, length = run % CLPV_LONGEST_RUN + 1;
    const uint at = (key >> low_bits) * chunks + c;
    const uint to = counts[at];
    counts[at] = to + length;
    for (uint k = 0; k < length; ++k) {
      sorted[2 * (to + k)] = key;
      sorted[2 * (to + k) + 1] = first + k;
    }
  }
}

// Adding up, first half: totals[digit] = sum over its chunks.
__kernel void sum_digits(__global const uint* counts, const uint chunks, const uint digits,
                         __global uint* totals) {
  const uint digit = get_global_id(0);
  if (digit >= digits) return;
  uint sum = 0;
  for (uint c = 0; c < chunks; ++c) sum += counts[digit * chunks + c];
  totals[digit] = sum;
}

// Adding up, second half: counts become where each chunk's first of a digit goes; all[0] how many there are.
__kernel void place_digits(__global uint* counts, const uint chunks, const uint digits,
                           __global const uint* totals, __global uint* all) {
  const uint digit = get_global_id(0);
  if (digit >= digits) return;
  uint at = 0;
  for (uint d = 0; d < digit; ++d) at += totals[d];
  for (uint c = 0; c < chunks; ++c) {
    const uint count = counts[digit * chunks + c];
    counts[digit * chunks + c] = at;
    at += count;
  }
  if (digit == digits - 1) all[0] = at;
}
