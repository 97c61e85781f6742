// SPDX-License-Identifier: MIT
// Exclusive prefix sum, in place: values[i] becomes the sum of the values before it.
//
//   sum_blocks     totals = sum of each block
//   place_blocks   the prefix sums; values[count] and total[0]: the sum of all
//
// A work-group sums a block. On CPUs the group is one work-item, which sums its block sequentially.
#include "lanes.h"
#if W == 1
#define CLPV_GROUP 64
#define CLPV_EACH 16  // consecutive values of a work-item
#else
#define CLPV_GROUP 1
#define CLPV_EACH 1024
#endif

static inline uint sum_of(__global const uint* values, const uint first, const uint end) {
  uint sum = 0;
  for (uint i = first; i < end; ++i) sum += values[i];
  return sum;
}

__attribute__((reqd_work_group_size(CLPV_GROUP, 1, 1)))
__kernel void sum_blocks(__global const uint* values, const uint count, __global uint* totals) {
  __local uint sums[CLPV_GROUP];
  const uint first = min((uint)get_global_id(0) * CLPV_EACH, count);
  sums[get_local_id(0)] = sum_of(values, first, min(first + CLPV_EACH, count));
  barrier(CLK_LOCAL_MEM_FENCE);
  if (get_local_id(0) != 0) return;
  uint sum = 0;
  for (uint i = 0; i < CLPV_GROUP; ++i) sum += sums[i];
  totals[get_group_id(0)] = sum;
}

__attribute__((reqd_work_group_size(CLPV_GROUP, 1, 1)))
__kernel void place_blocks(__global uint* values, const uint count, __global const uint* totals,
                           __global uint* total) {
  __local uint sums[CLPV_GROUP], before[CLPV_GROUP];
  const uint item = get_local_id(0), first = min((uint)get_global_id(0) * CLPV_EACH, count),
             end = min(first + CLPV_EACH, count);
  sums[item] = sum_of(values, first, end);
  uint blocks = 0;
  for (uint block = item; block < get_group_id(0); block += CLPV_GROUP) blocks += totals[block];
  before[item] = blocks;
  barrier(CLK_LOCAL_MEM_FENCE);
  uint at = 0;
  for (uint i = 0; i < CLPV_GROUP; ++i) at += before[i] + (i < item ? sums[i] : 0);
  if (first == end) return;
  for (uint i = first; i < end; ++i) {
    const uint value = values[i];
    values[i] = at;
    at += value;
  }
  if (end < count) return;
  values[count] = at;
  total[0] = at;
}
