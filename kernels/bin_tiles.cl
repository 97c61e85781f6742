// SPDX-License-Identifier: MIT
// Sorts what rasterize.cl entered by the slices of tiles: a counting sort whose counting it has done.
//
//   sum_places       what chunks of CLPV_SLICE_CHUNK slices hold in all
//   start_places     counts of entries become where each slice's first one goes; one more tells where the last ones end
//   bin_entries      entries -> binned: two words each, a triangle's place in the list and its least key
#include "shared/raster.h"

__kernel void sum_places(const uint slices, __global const uint* places, __global uint* totals) {
  const uint chunk = get_global_id(0), first = chunk * CLPV_SLICE_CHUNK;
  if (first >= slices) return;
  const uint end = min(first + CLPV_SLICE_CHUNK, slices);
  uint sum = 0;
  for (uint slice = first; slice < end; ++slice) sum += places[slice];
  totals[chunk] = sum;
}

__kernel void start_places(const uint slices, __global uint* places, __global const uint* totals) {
  const uint chunk = get_global_id(0), first = chunk * CLPV_SLICE_CHUNK;
  if (first >= slices) return;
  const uint end = min(first + CLPV_SLICE_CHUNK, slices);
  uint at = 0;
  for (uint before = 0; before < chunk; ++before) at += totals[before];
  for (uint slice = first; slice < end; ++slice) {
    const uint count = places[slice];
    places[slice] = at;
    at += count;
  }
  if (end == slices) places[slices] = at;
}

// A work-group takes CLPV_ENTRY_GROUP entries, so that there need not be a work-item for each that there is room for.
// Where the lists were too short there are gaps in them, and nothing is sorted.
__kernel void bin_entries(__global const uint* counts, const uint most_listed, const uint most_entered,
                          __global const uint* entries, __global const uint* places, __global uint2* binned) {
  const uint end = counts[CLPV_ENTERED], group = get_group_id(0) * CLPV_ENTRY_GROUP;
  if (group >= end || end > most_entered || counts[CLPV_ENTERED_TOO_MANY] > 0) return;
  if (counts[CLPV_LISTED] > most_listed) return;
  const uint stop = min(group + CLPV_ENTRY_GROUP, end);
  for (uint i = group + get_local_id(0); i < stop; i += get_local_size(0)) {
    const uint slice = entries[CLPV_ENTRY_WORDS * i];
    if (slice == CLPV_NO_SLICE) continue;
    binned[places[slice] + entries[CLPV_ENTRY_WORDS * i + 1]] =
        (uint2)(entries[CLPV_ENTRY_WORDS * i + 2], entries[CLPV_ENTRY_WORDS * i + 3]);
  }
}
