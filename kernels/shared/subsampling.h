// SPDX-License-Identifier: MIT
// Subsampling of a surface for injection, shared by host and kernels: every stride-th texel of
// every stride-th row. Each is the centre of the stride x stride texels that it represents.
#pragma once

// Number of samples of `texels` along a row or column.
static inline unsigned int sampled_texels(const unsigned int texels, const unsigned int stride) {
  return (texels + stride - 1u - stride / 2u) / stride;
}

// Coordinate of the i-th sampled texel.
static inline unsigned int sampled_texel(const unsigned int i, const unsigned int stride) {
  return i * stride + stride / 2u;
}
