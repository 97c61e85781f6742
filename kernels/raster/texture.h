// SPDX-License-Identifier: MIT
// Filtered look-ups in the scene's textures (shared/mesh.h), W at a time: bilinear and trilinear,
// with sRGB decoded before filtering. All levels of a texture wrap in the same way.
#pragma once

#include "lanes.h"
#include "shared/mesh.h"
#include "vec.h"

// Texture coordinates.
typedef struct {
  realW u, v;
} Uv;

// Attributes at barycentric weights w of the corners of a triangle.
static inline realW colour_at(const Vec w, __global const ClpvVertex* const* corner, const int i) {
  return interpolated(w, (realW)(corner[0]->colour[i]), (realW)(corner[1]->colour[i]),
                      (realW)(corner[2]->colour[i]));
}
static inline realW uv_at(const Vec w, __global const ClpvVertex* const* corner, const int i) {
  return interpolated(w, (realW)(corner[0]->uv[i]), (realW)(corner[1]->uv[i]),
                      (realW)(corner[2]->uv[i]));
}

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

// Texture coordinates in [0, 1], and masks of those that repeat.
typedef struct {
  realW u, v;
  intW repeat_u, repeat_v;
} Folded;

static inline Folded fold(const Uv uv, const uintW wrap) {
  const uintW wrap_u = wrap & 15u, wrap_v = wrap >> 4;
  const Folded folded = {fold_coordinate(uv.u, wrap_u), fold_coordinate(uv.v, wrap_v),
                         wrap_u == (uintW)(CLPV_WRAP_REPEAT), wrap_v == (uintW)(CLPV_WRAP_REPEAT)};
  return folded;
}

// The two texels on either side of a coordinate, and the weight of the second.
typedef struct {
  uintW first, second;
  realW weight;
} TexelPair;

static inline TexelPair find_texel_pair(const realW u, const uintW size, const intW repeat) {
  const realW at = u * to_realW(as_intW(size)) - 0.5f;
  const intW i = to_intW(at + 1.0f) - 1;  // floor(at), since at >= -1/2
  const intW last = as_intW(size) - 1, next = i + 1;
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

// Index of a texel in its level, as a sum over column and row (ClpvTexture: blocks of 4 x 4).
static inline uintW texel_column(const uintW x) { return 4u * x - 3u * (x & 3u); }
static inline uintW texel_row(const Level level, const uintW y) {
  return (y & ~3u) * ((level.width + 3u) & ~3u) + 4u * (y & 3u);
}

CLPV_INLINE void load_texel_quad(const Level level, __global const uint* texels, const Folded at,
                                 TexelQuad* quad) {
  const TexelPair x = find_texel_pair(at.u, level.width, at.repeat_u);
  const TexelPair y = find_texel_pair(at.v, level.height, at.repeat_v);
  const uintW upper = level.offset + texel_row(level, y.first),
              lower = level.offset + texel_row(level, y.second);
  const uintW left = texel_column(x.first), right = texel_column(x.second);
  const uintW at00 = upper + left, at01 = upper + right, at10 = lower + left, at11 = lower + right;
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
                                 const uintW entry, const Folded at, Vec* colour) {
  Level level;
  load_level(table, entry, &level);
  TexelQuad f;
  load_texel_quad(level, texels, at, &f);
  colour->x = filter_channel(f, 0);
  colour->y = filter_channel(f, 8);
  colour->z = filter_channel(f, 16);
}

// Divides by 255, so that a texel with the cutoff's byte compares equal to the cutoff.
static inline realW alpha_of(const uintW texel) {
  return to_realW(as_intW(texel >> 24)) / 255.0f;
}

// Bilinear look-up of alpha in a level, in [0, 1].
CLPV_INLINE realW sample_level_alpha(const Level level, __global const uint* texels, const Uv uv) {
  TexelQuad f;
  load_texel_quad(level, texels, fold(uv, level.wrap), &f);
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
  const Folded at = fold(uv, whole.wrap);
  Vec a, b;
  sample_bilinear(table, texels, finest + as_uintW(fine), at, &a);
  *colour = a;
  if (no_lane(weight > ZERO)) return;  // magnified: only level 0
  sample_bilinear(table, texels, finest + as_uintW(coarse), at, &b);
  colour->x = lerp(a.x, b.x, weight);
  colour->y = lerp(a.y, b.y, weight);
  colour->z = lerp(a.z, b.z, weight);
}
