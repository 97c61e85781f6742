// SPDX-License-Identifier: MIT
// Which texels of a surface injection takes: every stride-th along a row, of every stride-th row; each the middle one of
// those it stands for. As host and kernels both see it.
#ifndef CLPV_SHARED_THINNED_H
#define CLPV_SHARED_THINNED_H

// How many are taken of `texels` along a row or column.
#define CLPV_TAKEN(texels, stride) (((texels) + (stride) - 1u - (stride) / 2u) / (stride))

// Where the i-th taken one is along it.
#define CLPV_TAKEN_TEXEL(i, stride) ((i) * (stride) + (stride) / 2u)

#endif
