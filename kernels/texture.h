// Filtered look-ups in the scene's textures (kernels/shared/mesh.h): sRGB decoded before filtering, linear result.
// Selections instead of branches, and no floor() or log2(), which are calls on PoCL.
#ifndef CLPV_TEXTURE_H
#define CLPV_TEXTURE_H

#include "shared/mesh.h"
#include "srgb.h"
#include "vec.h"

// PoCL leaves functions of this size out of line, at a tenth of the cost of resolve.cl.
#define CLPV_INLINE static inline __attribute__((always_inline))

// A coordinate folded into the texture: 0..1. Mirroring the coordinate mirrors the texels, so that its two ends
// then clamp. A coordinate that is no number, or beyond the integers, reads 0.
static inline float clpv_fold(const float u, const uint wrap) {
  const float whole = (float)(int)u;
  const float repeated = u - (whole > u ? whole - 1.0f : whole);
  const float half_turns = (float)(int)(0.5f * u + (u < 0.0f ? -0.5f : 0.5f));
  const float mirrored = fabs(u - 2.0f * half_turns);
  const float clamped = u < 0.0f ? 0.0f : u > 1.0f ? 1.0f : u;
  float folded = wrap & CLPV_WRAP_MIRROR ? mirrored : repeated;
  folded = wrap & CLPV_WRAP_CLAMP ? clamped : folded;
  return folded >= 0.0f && folded <= 1.0f ? folded : 0.0f;
}

// The two texels a coordinate lies between, and the weight of the second.
typedef struct {
  int first, second;
  float weight;
} Between;

static inline Between clpv_between(const float u, const int size, const uint wrap) {
  const float at = clpv_fold(u, wrap) * (float)size - 0.5f;
  const int i = (int)(at + 1.0f) - 1;  // its floor: at is -1/2 or more
  const bool repeat = wrap == CLPV_WRAP_REPEAT;
  Between between;
  between.weight = at - (float)i;
  between.first = i >= 0 ? i : repeat ? size - 1 : 0;
  between.second = i + 1 < size ? i + 1 : repeat ? 0 : size - 1;
  return between;
}

static inline float clpv_mix(const float a, const float b, const float weight) {
  return a + weight * (b - a);
}

// The four texels round a point, and their weights: rows y, columns x.
typedef struct {
  uint texel[4];
  float x, y;
} Four;

CLPV_INLINE Four clpv_four(__global const ClpvTexture* texture, __global const uint* texels, const float u,
                           const float v) {
  const uint width = texture->width, wrap = texture->wrap, offset = texture->offset;
  const Between x = clpv_between(u, (int)width, wrap & 15u);
  const Between y = clpv_between(v, (int)texture->height, wrap >> 4);
  const uint upper = offset + (uint)y.first * width, lower = offset + (uint)y.second * width;
  Four four;
  four.texel[0] = texels[upper + (uint)x.first];
  four.texel[1] = texels[upper + (uint)x.second];
  four.texel[2] = texels[lower + (uint)x.first];
  four.texel[3] = texels[lower + (uint)x.second];
  four.x = x.weight;
  four.y = y.weight;
  return four;
}

static inline float clpv_filter(const Four f, const float a, const float b, const float c, const float d) {
  return clpv_mix(clpv_mix(a, b, f.x), clpv_mix(c, d, f.x), f.y);
}

// Bilinear, in one mip level: linear colour.
CLPV_INLINE Vec clpv_bilinear(__global const ClpvTexture* texture, __global const uint* texels, const float u,
                              const float v) {
  const Four f = clpv_four(texture, texels, u, v);
#define CLPV_CHANNEL(shift)                                                                        \
  clpv_filter(f, clpv_srgb[(f.texel[0] >> shift) & 255u], clpv_srgb[(f.texel[1] >> shift) & 255u], \
              clpv_srgb[(f.texel[2] >> shift) & 255u], clpv_srgb[(f.texel[3] >> shift) & 255u])
  return vec(CLPV_CHANNEL(0), CLPV_CHANNEL(8), CLPV_CHANNEL(16));
#undef CLPV_CHANNEL
}

// The same, of alpha: 0..1.
static inline float clpv_bilinear_alpha(__global const ClpvTexture* texture, __global const uint* texels,
                                        const float u, const float v) {
  const Four f = clpv_four(texture, texels, u, v);
#define CLPV_ALPHA(i) ((float)(int)(f.texel[i] >> 24) * (1.0f / 255.0f))
  return clpv_filter(f, CLPV_ALPHA(0), CLPV_ALPHA(1), CLPV_ALPHA(2), CLPV_ALPHA(3));
#undef CLPV_ALPHA
}

// The mip level, 0 being the texture itself, for steps of `square` squared texels from pixel to pixel: log2 of the
// step, by straight lines between the powers of two of its square (off by less than 1/20 of a level).
static inline float clpv_mip_level(const float square) {
  const float level = 0.5f * ((float)as_int(square) * (1.0f / 8388608.0f) - 127.0f);
  const float most = (float)(CLPV_TEXTURE_LEVELS - 1);
  return level > 0.0f ? (level < most ? level : most) : 0.0f;
}

// Trilinear: the mip levels chosen by the longer of the two steps (du, dv) that a pixel makes.
CLPV_INLINE Vec clpv_trilinear(__global const ClpvTexture* textures, __global const uint* texels,
                               const uint texture, const float u, const float v, const Uv step_x,
                               const Uv step_y) {
  __global const ClpvTexture* levels = textures + texture * CLPV_TEXTURE_LEVELS;
  const float width = (float)(int)levels->width, height = (float)(int)levels->height;
  const float xx = step_x.u * width, xy = step_x.v * height, yx = step_y.u * width, yy = step_y.v * height;
  const float x2 = xx * xx + xy * xy, y2 = yx * yx + yy * yy;
  const float level = clpv_mip_level(x2 > y2 ? x2 : y2);
  const int fine = (int)level;
  const int coarse = fine + 1 < CLPV_TEXTURE_LEVELS ? fine + 1 : fine;
  const float weight = level - (float)fine;
  const Vec a = clpv_bilinear(levels + fine, texels, u, v), b = clpv_bilinear(levels + coarse, texels, u, v);
  return vec(clpv_mix(a.x, b.x, weight), clpv_mix(a.y, b.y, weight), clpv_mix(a.z, b.z, weight));
}

#endif
