// SPDX-License-Identifier: MIT
// Sorts the entries of rasterize.cl by tile and depth slice: a counting sort. rasterize.cl has
// counted them, prefix_sum.cl has made `slice_starts` of the counts.
//
//   bin_entries    entries -> binned: index in the list of triangles, smallest key (two words each)
#include "shared/raster.h"

// A work-group sorts CLPV_ENTRY_GROUP entries. Returns at once if a list overflowed, since the
// lists then have gaps.
__kernel void bin_entries(__global const uint* counts, const uint most_listed,
                          const uint most_entered, __global const uint* entries,
                          __global const uint* slice_starts, __global uint2* binned) {
  const uint end = counts[CLPV_ENTERED], group = get_group_id(0) * CLPV_ENTRY_GROUP;
  if (group >= end || end > most_entered || counts[CLPV_ENTERED_TOO_MANY] > 0) return;
  if (counts[CLPV_LISTED] > most_listed) return;
  const uint stop = min(group + CLPV_ENTRY_GROUP, end);
  for (uint i = group + get_local_id(0); i < stop; i += get_local_size(0)) {
    const uint slice = entries[CLPV_ENTRY_WORDS * i];
    if (slice == CLPV_NO_SLICE) continue;
    binned[slice_starts[slice] + entries[CLPV_ENTRY_WORDS * i + 1]] =
        (uint2)(entries[CLPV_ENTRY_WORDS * i + 2], entries[CLPV_ENTRY_WORDS * i + 3]);
  }
}
