// SPDX-License-Identifier: MIT
// Light that surfaces give by themselves, as virtual point lights that injection takes (docs/method.md, 'Emissive surfaces').
//
// A point stands in the middle of each piece of a part (shared/emit.h) and has the flux of it, pi L A: L the mean radiance,
// A the area. Out, for injection (find_cells.cl): `positions` [m], `normals`, unit, on the side that shines, `fluxes` [W],
// each times `scale`; `places` of them, those beyond the last point empty. A work-item is a point.
//
// From the host: CLPV_TEXTURED, CLPV_MASKED; `white`, the texture of materials without one.
#include "lanes.h"
#include "shared/emit.h"
#include "texture.h"
#include "vec.h"

#define CLPV_EIGHT ((float8)(0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 7.0f))

// The part that a point is of: the last one that starts at or before it.
static inline uint clpv_part_of(__global const ClpvEmitter* parts, const uint count, const uint point) {
  uint low = 0, high = count - 1;
  while (low < high) {
    const uint middle = high - (high - low) / 2;
    if (parts[middle].first <= point) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

// A piece of a triangle's whole: where its first corner is, and its edges; one that is turned round has them negative.
// Row r of pieces has 2 r + 1, every second one turned.
typedef struct {
  float u, v, size;
} Piece;

static inline Piece clpv_piece(const ClpvEmitter part, const uint i) {
  uint row = (uint)sqrt((float)i);
  row -= row * row > i ? 1u : 0u;
  row += (row + 1u) * (row + 1u) <= i ? 1u : 0u;
  const uint along = i - row * row, column = along / 2, turned = along % 2;
  const float step = part.size / (float)part.rows;
  const Piece piece = {part.u + step * (float)(row - column), part.v + step * (float)(column + turned),
                       turned != 0 ? -step : step};
  return piece;
}

static inline float clpv_total(const float8 a) {
  const float4 four = a.lo + a.hi;
  return (four.x + four.y) + (four.z + four.w);
}

#if CLPV_TEXTURED || CLPV_MASKED

#define CLPV_BLEND(w1, w2, corner, field) \
  ((1.0f - (w1) - (w2)) * (corner)[0]->field + (w1) * (corner)[1]->field + (w2) * (corner)[2]->field)

// How much of its factor a material emits on a piece.
CLPV_INLINE void clpv_mean(const Piece piece, __global const ClpvVertex* const corner[3],
                           __global const ClpvMaterial* material, const uint white, __global const float4* textures,
                           __global const uint* texels, float mean[3]) {
  mean[0] = mean[1] = mean[2] = 1.0f;
#if CLPV_MASKED
  const bool masked = (material->flags & CLPV_MATERIAL_MASKED) != 0;
#else
  const bool masked = false;
#endif
  if (material->emissive_texture == white && !masked) return;
  const float step = piece.size * (1.0f / CLPV_EMIT_LOOKS), reach = CLPV_EMIT_FOOTPRINT * step;
  const float u1 = corner[1]->uv[0] - corner[0]->uv[0], v1 = corner[1]->uv[1] - corner[0]->uv[1];
  const float u2 = corner[2]->uv[0] - corner[0]->uv[0], v2 = corner[2]->uv[1] - corner[0]->uv[1];
  const Uv to_second = {(float8)(reach * u1), (float8)(reach * v1)};
  const Uv to_third = {(float8)(reach * u2), (float8)(reach * v2)};
  float8 red = 0.0f, green = 0.0f, blue = 0.0f;
  for (int i = 0; i < CLPV_EMIT_LOOKS * CLPV_EMIT_LOOKS; i += 8) {
    const float8 at = (float)i + CLPV_EIGHT;
    const float8 row = convert_float8(convert_int8(sqrt(at + 0.5f)));
    const float8 along = at - row * row;
    const float8 column = convert_float8(convert_int8(0.5f * along)), turned = along - 2.0f * column;
    const float8 middle = (1.0f / 3.0f) * (1.0f - 2.0f * turned);
    const float8 w1 = piece.u + step * (row - column + middle), w2 = piece.v + step * (column + turned + middle);
    const Uv uv = {CLPV_BLEND(w1, w2, corner, uv[0]), CLPV_BLEND(w1, w2, corner, uv[1])};
    Vec look = vec((float8)(1.0f), (float8)(1.0f), (float8)(1.0f));
    if (material->emissive_texture != white)
      clpv_trilinear(textures, texels, (uint8)(material->emissive_texture), uv, to_second, to_third, &look);
#if CLPV_MASKED
    if (masked) {
      const float8 alpha =
          material->base_colour[3] * CLPV_BLEND(w1, w2, corner, colour[3]) *
          clpv_bilinear_alpha(textures, texels, (uint8)(material->texture * CLPV_TEXTURE_LEVELS), uv);
      const float8 none = (float8)(0.0f), all = (float8)(1.0f);
      look = vec_times(look, alpha >= (float8)(material->alpha_cutoff) ? all : none);
    }
#endif
    red += look.x, green += look.y, blue += look.z;
  }
  const float each = 1.0f / (CLPV_EMIT_LOOKS * CLPV_EMIT_LOOKS);
  mean[0] = each * clpv_total(red), mean[1] = each * clpv_total(green), mean[2] = each * clpv_total(blue);
}

#endif

__kernel void emit(__global const ClpvEmitter* parts, const uint count, const uint points, const uint places,
                   const float scale, __global const ClpvVertex* vertices, __global const ClpvTriangle* triangles,
                   __global const ClpvMaterial* materials, const uint white, __global const float4* textures,
                   __global const uint* texels, __global float4* positions, __global float4* normals,
                   __global float4* fluxes) {
  const uint i = get_global_id(0);
  if (i >= places) return;
  positions[i] = normals[i] = fluxes[i] = (float4)(0.0f);
  if (i >= points) return;
  const ClpvEmitter part = parts[clpv_part_of(parts, count, i)];
  const ClpvTriangle triangle = triangles[part.triangle];
  __global const ClpvVertex* const corner[3] = {vertices + triangle.vertex[0], vertices + triangle.vertex[1],
                                                vertices + triangle.vertex[2]};
  __global const ClpvMaterial* material = materials + triangle.material;
  const Piece piece = clpv_piece(part, i - part.first);
  const float w1 = piece.u + piece.size * (1.0f / 3.0f), w2 = piece.v + piece.size * (1.0f / 3.0f);
  float e1[3], e2[3], at[3];
  for (int a = 0; a < 3; ++a) {
    e1[a] = corner[1]->position[a] - corner[0]->position[a];
    e2[a] = corner[2]->position[a] - corner[0]->position[a];
    at[a] = corner[0]->position[a] + w1 * e1[a] + w2 * e2[a];
  }
  const float x = e1[1] * e2[2] - e1[2] * e2[1], y = e1[2] * e2[0] - e1[0] * e2[2], z = e1[0] * e2[1] - e1[1] * e2[0];
  const float twice = sqrt(x * x + y * y + z * z);  // the triangle's area
  if (!(twice > 0.0f)) return;
  float mean[3] = {1.0f, 1.0f, 1.0f};
#if CLPV_TEXTURED || CLPV_MASKED
  clpv_mean(piece, corner, material, white, textures, texels, mean);
#endif
  const float flux = scale * (M_PI_F * 0.5f) * twice * (piece.size * piece.size), facing = part.side / twice;
  positions[i] = (float4)(at[0], at[1], at[2], 1.0f);
  normals[i] = (float4)(facing * x, facing * y, facing * z, 0.0f);
  fluxes[i] = (float4)(flux * mean[0] * material->emissive[0], flux * mean[1] * material->emissive[1],
                       flux * mean[2] * material->emissive[2], 1.0f);
}
