// Which texels of a surface injection takes: every CLPV_STRIDE-th along a row, of every CLPV_STRIDE-th row; each the
// middle one of those it stands for.
#ifndef CLPV_THINNED_H
#define CLPV_THINNED_H

#ifndef CLPV_STRIDE
#define CLPV_STRIDE 1u
#endif

// How many are taken of `texels` along a row or column.
static inline uint taken(const uint texels) { return (texels + CLPV_STRIDE - 1u - CLPV_STRIDE / 2u) / CLPV_STRIDE; }

// Where the i-th taken one is along it.
static inline uint taken_texel(const uint i) { return i * CLPV_STRIDE + CLPV_STRIDE / 2u; }

// Index of the i-th taken texel of a surface of rows of `width` texels.
static inline uint taken_index(const uint width, const uint i) {
#if CLPV_STRIDE == 1
  return i;
#else
  const uint of_row = taken(width);
  return taken_texel(i / of_row) * width + taken_texel(i % of_row);
#endif
}

#endif
