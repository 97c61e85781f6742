// Filtered look-ups in the scene's textures (kernels/shared/mesh.h): sRGB decoded before filtering, linear
// result.
#ifndef CLPV_TEXTURE_H
#define CLPV_TEXTURE_H

#include "shared/mesh.h"
#include "srgb.h"

// A coordinate folded into the texture: 0..1. Mirroring the coordinate mirrors the texels, so that its two
// ends then clamp.
static inline float clpv_fold(const float u, const uint wrap) {
  if (wrap == CLPV_WRAP_REPEAT) return u - floor(u);
  if (wrap == CLPV_WRAP_MIRROR) return fabs(u - 2.0f * rint(0.5f * u));
  return clamp(u, 0.0f, 1.0f);
}

// The two texels a coordinate lies between, and the weight of the second.
typedef struct {
  int first, second;
  float weight;
} Between;

static inline Between clpv_between(const float u, const int size, const uint wrap) {
  const float at = clpv_fold(u, wrap) * (float)size - 0.5f;
  const float before = floor(at);
  const int i = (int)before;
  const bool repeat = wrap == CLPV_WRAP_REPEAT;
  Between between;
  between.weight = at - before;
  // The last clamp also keeps a coordinate that is no number inside the texture.
  between.first = clamp(i < 0 && repeat ? size - 1 : i, 0, size - 1);
  between.second = clamp(i + 1 >= size && repeat ? 0 : i + 1, 0, size - 1);
  return between;
}

static inline float4 clpv_decode(const uchar4 texel) {
  return (float4)(clpv_srgb[texel.x], clpv_srgb[texel.y], clpv_srgb[texel.z],
                  (float)texel.w * (1.0f / 255.0f));
}

// Bilinear, in one mip level. Linear colour and alpha.
static inline float4 clpv_bilinear(const ClpvTexture texture, __global const uchar4* texels,
                                   const float2 uv) {
  const Between x = clpv_between(uv.x, (int)texture.width, texture.wrap & 15u);
  const Between y = clpv_between(uv.y, (int)texture.height, texture.wrap >> 4);
  __global const uchar4* upper = texels + texture.offset + (uint)y.first * texture.width;
  __global const uchar4* lower = texels + texture.offset + (uint)y.second * texture.width;
  return mix(mix(clpv_decode(upper[x.first]), clpv_decode(upper[x.second]), x.weight),
             mix(clpv_decode(lower[x.first]), clpv_decode(lower[x.second]), x.weight), y.weight);
}

// The same, of alpha alone.
static inline float clpv_bilinear_alpha(const ClpvTexture texture, __global const uchar4* texels,
                                        const float2 uv) {
  const Between x = clpv_between(uv.x, (int)texture.width, texture.wrap & 15u);
  const Between y = clpv_between(uv.y, (int)texture.height, texture.wrap >> 4);
  __global const uchar4* upper = texels + texture.offset + (uint)y.first * texture.width;
  __global const uchar4* lower = texels + texture.offset + (uint)y.second * texture.width;
  return mix(mix((float)upper[x.first].w, (float)upper[x.second].w, x.weight),
             mix((float)lower[x.first].w, (float)lower[x.second].w, x.weight), y.weight) *
         (1.0f / 255.0f);
}

// Trilinear: mip levels chosen by the longer of the two steps in uv that a pixel makes, so that a texel of
// the level is about as large as that.
static inline float4 clpv_trilinear(__global const ClpvTexture* textures, __global const uchar4* texels,
                                    const uint texture, const float2 uv, const float2 uv_x,
                                    const float2 uv_y) {
  __global const ClpvTexture* levels = textures + texture * CLPV_TEXTURE_LEVELS;
  const float2 size = (float2)((float)levels[0].width, (float)levels[0].height);
  const float2 x = uv_x * size, y = uv_y * size;
  // fmin: steps that are no number (a surface seen edge-on) take the coarsest level.
  const float square = fmax(dot(x, x), dot(y, y));
  const float level = clamp(0.5f * log2(fmin(square, 1e9f)), 0.0f, (float)(CLPV_TEXTURE_LEVELS - 1));
  const uint fine = (uint)level;
  const float4 colour = clpv_bilinear(levels[fine], texels, uv);
  const float weight = level - (float)fine;
  if (weight == 0.0f) return colour;
  return mix(colour, clpv_bilinear(levels[min(fine + 1u, CLPV_TEXTURE_LEVELS - 1u)], texels, uv), weight);
}

#endif
