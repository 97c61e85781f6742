// SPDX-License-Identifier: MIT
// What the sort by cell (kernels/sort_by_cell.cl) and those who use it agree on, as host and kernels both see it.
#ifndef CLPV_SHARED_SORT_H
#define CLPV_SHARED_SORT_H

#define CLPV_NO_CELL 0xffffffffu  // key of a texel that belongs to no cell: the sort drops it

// Texels of a run at most. Runs end at its multiples, so that no run crosses a chunk. Its length less one is kept in
// the low bits of a run's entry, above them its first texel.
#define CLPV_LONGEST_RUN 16u
#define CLPV_RUN_BITS 4u

#endif
