// SPDX-License-Identifier: MIT
// Constants of the sort by cell (kernels/inject/sort_by_cell.cl), shared by host and kernels.
#pragma once

#define CLPV_NO_CELL 0xffffffffu  // key of a texel without a cell; the sort drops it

// Maximum length of a run [texels]. Runs end at its multiples, so that none crosses a chunk. The
// low CLPV_RUN_BITS bits of a run's word hold its length minus 1, the bits above its first texel.
#define CLPV_LONGEST_RUN 16u
#define CLPV_RUN_BITS 4u
