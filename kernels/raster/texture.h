// SPDX-License-Identifier: MIT
// Filtered look-ups in the scene's textures (shared/mesh.h), eight at a time: bilinear and trilinear, with sRGB decoded
// before filtering.
#ifndef CLPV_TEXTURE_H
#define CLPV_TEXTURE_H

#include "lanes.h"
#include "shared/mesh.h"
#include "vec.h"

// Texture coordinates.
typedef struct {
  float8 u, v;
} Uv;

// Entries of the texture table, one per lane.
typedef struct {
  uint8 offset, width, height, wrap;
} Level;

CLPV_INLINE void clpv_level(__global const float4* table, const uint8 entry, Level* level) {
  Rows rows;
  gather_rows(table, entry, &rows);
  level->offset = as_uint8(CLPV_COLUMN(rows, x));
  level->width = as_uint8(CLPV_COLUMN(rows, y));
  level->height = as_uint8(CLPV_COLUMN(rows, z));
  level->wrap = as_uint8(CLPV_COLUMN(rows, w));
}

// Loads the same entry for all lanes.
CLPV_INLINE void clpv_level_for_all(__global const float4* table, const uint entry, Level* level) {
  const uint4 row = as_uint4(table[entry]);
  level->offset = (uint8)(row.x);
  level->width = (uint8)(row.y);
  level->height = (uint8)(row.z);
  level->wrap = (uint8)(row.w);
}

// Wraps a coordinate to [0, 1] by repeating, mirroring or clamping. NaN and coordinates beyond the range of int become
// 0.
static inline float8 clpv_fold(const float8 u, const uint8 wrap) {
  const float8 none = (float8)(0.0f), all = (float8)(1.0f);
  const float8 whole = convert_float8(convert_int8(u));
  const float8 repeated = u - (whole > u ? whole - all : whole);
  const float8 turns = convert_float8(convert_int8(0.5f * u + (u < none ? (float8)(-0.5f) : (float8)(0.5f))));
  const float8 mirrored = fabs(u - 2.0f * turns);
  const float8 clamped = u < none ? none : (u > all ? all : u);
  float8 folded = (wrap & CLPV_WRAP_MIRROR) != 0u ? mirrored : repeated;
  folded = (wrap & CLPV_WRAP_CLAMP) != 0u ? clamped : folded;
  return ((folded >= none) & (folded <= all)) ? folded : none;
}

// The two texels on either side of a coordinate, and the weight of the second.
typedef struct {
  uint8 first, second;
  float8 weight;
} TexelPair;

static inline TexelPair clpv_texel_pair(const float8 u, const uint8 size, const uint8 wrap) {
  const float8 at = clpv_fold(u, wrap) * convert_float8(as_int8(size)) - 0.5f;
  const int8 i = convert_int8(at + 1.0f) - 1;  // floor(at), since at >= -1/2
  const int8 last = as_int8(size) - 1, next = i + 1;
  const int8 repeat = wrap == (uint8)(CLPV_WRAP_REPEAT);
  TexelPair pair;
  pair.weight = at - convert_float8(i);
  pair.first = as_uint8(i >= 0 ? i : repeat & last);
  pair.second = as_uint8(next <= last ? next : ~repeat & last);
  return pair;
}

static inline float8 clpv_mix(const float8 a, const float8 b, const float8 weight) {
  return a + weight * (b - a);
}

// The four texels about a point, and its weights.
typedef struct {
  uint8 texel00, texel01, texel10, texel11;  // row, column
  float8 x, y;
} TexelQuad;

CLPV_INLINE void clpv_texel_quad(const Level level, __global const uint* texels, const Uv uv, TexelQuad* quad) {
  const TexelPair x = clpv_texel_pair(uv.u, level.width, level.wrap & 15u);
  const TexelPair y = clpv_texel_pair(uv.v, level.height, level.wrap >> 4);
  const uint8 upper = level.offset + y.first * level.width, lower = level.offset + y.second * level.width;
  const uint8 at00 = upper + x.first, at01 = upper + x.second, at10 = lower + x.first,
              at11 = lower + x.second;
  // Volatile keeps LLVM from gather instructions, which are slower than scalar loads on processors with mitigations.
  volatile __global const uint* each = texels;
  quad->texel00 = (uint8)CLPV_GATHER(each, at00);
  quad->texel01 = (uint8)CLPV_GATHER(each, at01);
  quad->texel10 = (uint8)CLPV_GATHER(each, at10);
  quad->texel11 = (uint8)CLPV_GATHER(each, at11);
  quad->x = x.weight;
  quad->y = y.weight;
}

static inline float8 clpv_filter(const TexelQuad f, const float8 a, const float8 b, const float8 c,
                                 const float8 d) {
  return clpv_mix(clpv_mix(a, b, f.x), clpv_mix(c, d, f.x), f.y);
}

// Decodes sRGB bytes to linear light, within 5e-7; 255 is exact. The part ((x + 0.055) / 1.055)^2.4 is a polynomial in
// sqrt(x).
static inline float8 clpv_decode(const uint8 byte) {
  const float8 x = convert_float8(as_int8(byte)) * (1.0f / 255.0f), s = sqrt(x);
  float8 linear = -0.0757972151f + s * 0.0097230114f;
  linear = 0.798697114f + s * linear;
  linear = 0.171209872f + s * linear;
  linear = 0.0683239773f + s * linear;
  linear = 0.0261482038f + s * linear;
  linear = 0.000896090001f + s * linear;
  linear = 0.000798965106f + s * linear;
  return byte > 10u ? linear : x * (1.0f / 12.92f);
}

// Bilinear look-up in one entry of the table: linear colour.
CLPV_INLINE void clpv_bilinear(__global const float4* table, __global const uint* texels, const uint8 entry,
                               const Uv uv, Vec* colour) {
  Level level;
  clpv_level(table, entry, &level);
  TexelQuad f;
  clpv_texel_quad(level, texels, uv, &f);
#define CLPV_CHANNEL(shift)                                                                          \
  clpv_filter(f, clpv_decode((f.texel00 >> shift) & 255u), clpv_decode((f.texel01 >> shift) & 255u), \
              clpv_decode((f.texel10 >> shift) & 255u), clpv_decode((f.texel11 >> shift) & 255u))
  colour->x = CLPV_CHANNEL(0);
  colour->y = CLPV_CHANNEL(8);
  colour->z = CLPV_CHANNEL(16);
#undef CLPV_CHANNEL
}

// Bilinear look-up of alpha in a level, in [0, 1].
CLPV_INLINE float8 clpv_level_alpha(const Level level, __global const uint* texels, const Uv uv) {
  TexelQuad f;
  clpv_texel_quad(level, texels, uv, &f);
#define CLPV_ALPHA(texel) (convert_float8(as_int8((texel) >> 24)) * (1.0f / 255.0f))
  return clpv_filter(f, CLPV_ALPHA(f.texel00), CLPV_ALPHA(f.texel01), CLPV_ALPHA(f.texel10),
                     CLPV_ALPHA(f.texel11));
#undef CLPV_ALPHA
}

CLPV_INLINE float8 clpv_bilinear_alpha(__global const float4* table, __global const uint* texels,
                                       const uint8 entry, const Uv uv) {
  Level level;
  clpv_level(table, entry, &level);
  return clpv_level_alpha(level, texels, uv);
}

// Mip level for a squared step of `square` texels^2 from pixel to pixel: log2 of the step, piecewise linear in the
// square (error below 0.05 levels). Level 0 is the texture itself.
static inline float8 clpv_mip_level(const float8 square) {
  const float8 none = (float8)(0.0f), highest = (float8)(CLPV_TEXTURE_LEVELS - 1.0f);
  const float8 level = 0.5f * (convert_float8(as_int8(square)) * (1.0f / 8388608.0f) - 127.0f);
  return level > none ? (level < highest ? level : highest) : none;
}

// Trilinear look-up. `step_x`, `step_y`: change of uv from pixel to pixel; the longer step selects the mip level.
CLPV_INLINE void clpv_trilinear(__global const float4* table, __global const uint* texels,
                                const uint8 texture, const Uv uv, const Uv step_x, const Uv step_y,
                                Vec* colour) {
  const uint8 finest = texture * CLPV_TEXTURE_LEVELS;
  Level whole;
  clpv_level(table, finest, &whole);
  const float8 width = convert_float8(as_int8(whole.width)), height = convert_float8(as_int8(whole.height));
  const float8 xu = step_x.u * width, xv = step_x.v * height, yu = step_y.u * width, yv = step_y.v * height;
  const float8 x2 = xu * xu + xv * xv, y2 = yu * yu + yv * yv;
  const float8 level = clpv_mip_level(x2 > y2 ? x2 : y2);
  const int8 fine = convert_int8(level);
  const int8 coarse = fine + 1 < CLPV_TEXTURE_LEVELS ? fine + 1 : fine;
  const float8 weight = level - convert_float8(fine);
  Vec a, b;
  clpv_bilinear(table, texels, finest + as_uint8(fine), uv, &a);
  *colour = a;
  if (none(weight > (float8)(0.0f))) return;  // magnified: only level 0
  clpv_bilinear(table, texels, finest + as_uint8(coarse), uv, &b);
  colour->x = clpv_mix(a.x, b.x, weight);
  colour->y = clpv_mix(a.y, b.y, weight);
  colour->z = clpv_mix(a.z, b.z, weight);
}

#endif
