// SPDX-License-Identifier: MIT
// Filtered look-ups in the scene's textures (shared/mesh.h), W at a time: bilinear and trilinear,
// with sRGB decoded before filtering.
#pragma once

#include "lanes.h"
#include "shared/mesh.h"
#include "vec.h"

// Texture coordinates.
typedef struct {
  realW u, v;
} Uv;

// Entries of the texture table, one per lane.
typedef struct {
  uintW offset, width, height, wrap;
} Level;

CLPV_INLINE void load_level(__global const float4* table, const uintW entry, Level* level) {
  Rows rows;
  gather_rows(table, entry, &rows);
  level->offset = as_uintW(CLPV_COLUMN(rows, x));
  level->width = as_uintW(CLPV_COLUMN(rows, y));
  level->height = as_uintW(CLPV_COLUMN(rows, z));
  level->wrap = as_uintW(CLPV_COLUMN(rows, w));
}

// Loads the same entry for all lanes.
CLPV_INLINE void load_level_for_all(__global const float4* table, const uint entry, Level* level) {
  const uint4 row = as_uint4(table[entry]);
  level->offset = (uintW)(row.x);
  level->width = (uintW)(row.y);
  level->height = (uintW)(row.z);
  level->wrap = (uintW)(row.w);
}

// Wraps a coordinate to [0, 1] by repeating, mirroring or clamping. NaN and coordinates beyond the
// range of int become 0.
static inline realW fold_coordinate(const realW u, const uintW wrap) {
  const realW whole = to_realW(to_intW(u));
  const realW repeated = u - (whole > u ? whole - ONE : whole);
  const realW turns = to_realW(to_intW(0.5f * u + (u < ZERO ? (realW)(-0.5f) : (realW)(0.5f))));
  const realW mirrored = fabs(u - 2.0f * turns);
  const realW clamped = u < ZERO ? ZERO : (u > ONE ? ONE : u);
  realW folded = (wrap & CLPV_WRAP_MIRROR) != 0u ? mirrored : repeated;
  folded = (wrap & CLPV_WRAP_CLAMP) != 0u ? clamped : folded;
  return ((folded >= ZERO) & (folded <= ONE)) ? folded : ZERO;
}

// The two texels on either side of a coordinate, and the weight of the second.
typedef struct {
  uintW first, second;
  realW weight;
} TexelPair;

static inline TexelPair find_texel_pair(const realW u, const uintW size, const uintW wrap) {
  const realW at = fold_coordinate(u, wrap) * to_realW(as_intW(size)) - 0.5f;
  const intW i = to_intW(at + 1.0f) - 1;  // floor(at), since at >= -1/2
  const intW last = as_intW(size) - 1, next = i + 1;
  const intW repeat = wrap == (uintW)(CLPV_WRAP_REPEAT);
  TexelPair pair;
  pair.weight = at - to_realW(i);
  pair.first = as_uintW(i >= 0 ? i : (repeat ? last : (intW)(0)));
  pair.second = as_uintW(next <= last ? next : (repeat ? (intW)(0) : last));
  return pair;
}

static inline realW lerp(const realW a, const realW b, const realW weight) {
  return a + weight * (b - a);
}

// The four texels about a point, and its weights.
typedef struct {
  uintW texel00, texel01, texel10, texel11;  // row, column
  realW x, y;
} TexelQuad;

CLPV_INLINE void load_texel_quad(const Level level, __global const uint* texels, const Uv uv,
                                 TexelQuad* quad) {
  const TexelPair x = find_texel_pair(uv.u, level.width, level.wrap & 15u);
  const TexelPair y = find_texel_pair(uv.v, level.height, level.wrap >> 4);
  const uintW upper = level.offset + y.first * level.width,
              lower = level.offset + y.second * level.width;
  const uintW at00 = upper + x.first, at01 = upper + x.second, at10 = lower + x.first,
              at11 = lower + x.second;
  // Volatile keeps LLVM from gather instructions, which are slower than scalar loads on processors
  // with mitigations.
  volatile __global const uint* each = texels;
  quad->texel00 = (uintW)CLPV_GATHER(each, at00);
  quad->texel01 = (uintW)CLPV_GATHER(each, at01);
  quad->texel10 = (uintW)CLPV_GATHER(each, at10);
  quad->texel11 = (uintW)CLPV_GATHER(each, at11);
  quad->x = x.weight;
  quad->y = y.weight;
}

static inline realW filter_quad(const TexelQuad f, const realW a, const realW b, const realW c,
                                const realW d) {
  return lerp(lerp(a, b, f.x), lerp(c, d, f.x), f.y);
}

// Decodes sRGB bytes to linear light, within 5e-7; 255 is exact. The part ((x + 0.055) / 1.055)^2.4
// is a polynomial in sqrt(x).
static inline realW decode_srgb(const uintW byte) {
  const realW x = to_realW(as_intW(byte)) * (1.0f / 255.0f), s = sqrt(x);
  realW linear = -0.0757972151f + s * 0.0097230114f;
  linear = 0.798697114f + s * linear;
  linear = 0.171209872f + s * linear;
  linear = 0.0683239773f + s * linear;
  linear = 0.0261482038f + s * linear;
  linear = 0.000896090001f + s * linear;
  linear = 0.000798965106f + s * linear;
  return byte > 10u ? linear : x * (1.0f / 12.92f);
}

// The channel of four texels whose byte is at bit `shift`: linear.
CLPV_INLINE realW filter_channel(const TexelQuad f, const uint shift) {
  return filter_quad(
      f, decode_srgb((f.texel00 >> shift) & 255u), decode_srgb((f.texel01 >> shift) & 255u),
      decode_srgb((f.texel10 >> shift) & 255u), decode_srgb((f.texel11 >> shift) & 255u));
}

// Bilinear look-up in one entry of the table: linear colour.
CLPV_INLINE void sample_bilinear(__global const float4* table, __global const uint* texels,
                                 const uintW entry, const Uv uv, Vec* colour) {
  Level level;
  load_level(table, entry, &level);
  TexelQuad f;
  load_texel_quad(level, texels, uv, &f);
  colour->x = filter_channel(f, 0);
  colour->y = filter_channel(f, 8);
  colour->z = filter_channel(f, 16);
}

// Divided, so that a texel of the cutoff's value equals it.
static inline realW alpha_of(const uintW texel) {
  return to_realW(as_intW(texel >> 24)) / 255.0f;
}

// Bilinear look-up of alpha in a level, in [0, 1].
CLPV_INLINE realW sample_level_alpha(const Level level, __global const uint* texels, const Uv uv) {
  TexelQuad f;
  load_texel_quad(level, texels, uv, &f);
  return filter_quad(f, alpha_of(f.texel00), alpha_of(f.texel01), alpha_of(f.texel10),
                     alpha_of(f.texel11));
}

CLPV_INLINE realW sample_alpha(__global const float4* table, __global const uint* texels,
                               const uintW entry, const Uv uv) {
  Level level;
  load_level(table, entry, &level);
  return sample_level_alpha(level, texels, uv);
}

// Mip level for a squared step of `square` texels^2 from pixel to pixel: log2 of the step,
// piecewise linear in the square (error below 0.05 levels). Level 0 is the texture itself.
static inline realW find_mip_level(const realW square) {
  const realW highest = (realW)(CLPV_TEXTURE_LEVELS - 1.0f);
  const realW level = 0.5f * (to_realW(as_intW(square)) * (1.0f / 8388608.0f) - 127.0f);
  return level > ZERO ? (level < highest ? level : highest) : ZERO;
}

// Trilinear look-up. `step_x`, `step_y`: change of uv from pixel to pixel; the longer step selects
// the mip level.
CLPV_INLINE void sample_trilinear(__global const float4* table, __global const uint* texels,
                                  const uintW texture, const Uv uv, const Uv step_x,
                                  const Uv step_y, Vec* colour) {
  const uintW finest = texture * CLPV_TEXTURE_LEVELS;
  Level whole;
  load_level(table, finest, &whole);
  const realW width = to_realW(as_intW(whole.width)), height = to_realW(as_intW(whole.height));
  const realW xu = step_x.u * width, xv = step_x.v * height, yu = step_y.u * width,
              yv = step_y.v * height;
  const realW x2 = xu * xu + xv * xv, y2 = yu * yu + yv * yv;
  const realW level = find_mip_level(x2 > y2 ? x2 : y2);
  const intW fine = to_intW(level);
  const intW coarse = fine + 1 < CLPV_TEXTURE_LEVELS ? fine + 1 : fine;
  const realW weight = level - to_realW(fine);
  Vec a, b;
  sample_bilinear(table, texels, finest + as_uintW(fine), uv, &a);
  *colour = a;
  if (no_lane(weight > ZERO)) return;  // magnified: only level 0
  sample_bilinear(table, texels, finest + as_uintW(coarse), uv, &b);
  colour->x = lerp(a.x, b.x, weight);
  colour->y = lerp(a.y, b.y, weight);
  colour->z = lerp(a.z, b.z, weight);
}
