// SPDX-License-Identifier: MIT
// Sorts the texels of a surface by cell: a stable radix sort of two passes, low and high digit,
// without atomics. Sums of a cell's texels are then deterministic (docs/method.md, 'Injection').
//
//   count_runs, scatter_runs        low digit: texels -> runs
//   count_texels, scatter_texels    high digit: runs -> sorted texels
//
// Neighbouring texels mostly belong to one cell. The first pass sorts runs of them, which are far
// fewer than texels; the second splits them again.
//
// In:   keys    cell of each texel, or CLPV_NO_CELL (cell_keys.h)
// Out:  sorted  (key, texel) of each texel that has a cell, two words each; their number is the
//               `total` of prefix_sum.cl
// counts[digit][chunk], after the histogram: elements of the chunk with that digit; after
// prefix_sum.cl: output index of the first of them.
#include "shared/sort.h"

// A run starts where the key changes, and at every multiple of CLPV_LONGEST_RUN.
static inline bool starts_run(const uint texel, const uint key, const uint previous) {
  return key != CLPV_NO_CELL && (key != previous || texel % CLPV_LONGEST_RUN == 0);
}

static inline uint run_length(__global const uint* keys, const uint texels, const uint first,
                              const uint key) {
  const uint stop = min(texels, first - first % CLPV_LONGEST_RUN + CLPV_LONGEST_RUN);
  uint end = first + 1;
  while (end < stop && keys[end] == key) ++end;
  return end - first;
}

// Zeroes the counts of a chunk.
static inline void clear_chunk(__global uint* counts, const uint digits, const uint chunks,
                               const uint c) {
  for (uint digit = 0; digit < digits; ++digit) counts[digit * chunks + c] = 0;
}

// First pass, histogram. A work-item counts `chunk` texels, a multiple of CLPV_LONGEST_RUN.
__kernel void count_runs(__global const uint* keys, const uint texels, const uint chunk,
                         const uint chunks, const uint low_bits, __global uint* counts) {
  const uint c = get_global_id(0);
  if (c >= chunks) return;
  clear_chunk(counts, 1u << low_bits, chunks, c);
  const uint last = min((c + 1) * chunk, texels);
  const uint mask = (1u << low_bits) - 1u;
  uint previous = CLPV_NO_CELL;
  for (uint texel = c * chunk; texel < last; ++texel) {
    const uint key = keys[texel];
    if (starts_run(texel, key, previous)) ++counts[(key & mask) * chunks + c];
    previous = key;
  }
}

// First pass, scatter. runs[2 i]: key; runs[2 i + 1]: first texel and length. Not a uint2: Oclgrind
// 21.10 reports a false error for its store.
__kernel void scatter_runs(__global const uint* keys, const uint texels, const uint chunk,
                           const uint chunks, const uint low_bits, __global uint* counts,
                           __global uint* runs) {
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

// Second pass, histogram of texels. A work-item counts `chunk` runs.
__kernel void count_texels(__global const uint* runs, __global const uint* run_count,
                           const uint chunk, const uint chunks, const uint low_bits,
                           const uint high_digits, __global uint* counts) {
  const uint c = get_global_id(0);
  if (c >= chunks) return;
  clear_chunk(counts, high_digits, chunks, c);
  const uint last = min((c + 1) * chunk, run_count[0]);
  for (uint i = c * chunk; i < last; ++i) {
    counts[(runs[2 * i] >> low_bits) * chunks + c] += runs[2 * i + 1] % CLPV_LONGEST_RUN + 1;
  }
}

// Second pass, scatter. sorted[2 i]: key; sorted[2 i + 1]: texel.
__kernel void scatter_texels(__global const uint* runs, __global const uint* run_count,
                             const uint chunk, const uint chunks, const uint low_bits,
                             __global uint* counts, __global uint* sorted) {
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
