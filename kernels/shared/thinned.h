// SPDX-License-Identifier: MIT
// Subsampling of a surface for injection, shared by host and kernels: every stride-th texel of
// every stride-th row. Each is the centre of the stride x stride texels that it represents.
#pragma once

// Number of texels taken of `texels` along a row or column.
#define CLPV_TAKEN(texels, stride) (((texels) + (stride) - 1u - (stride) / 2u) / (stride))

// Coordinate of the i-th texel taken.
#define CLPV_TAKEN_TEXEL(i, stride) ((i) * (stride) + (stride) / 2u)
