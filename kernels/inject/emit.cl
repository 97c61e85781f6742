// SPDX-License-Identifier: MIT
// Places virtual point lights on emissive surfaces (docs/method.md, 'Emissive surfaces').
//
//   P = pi L A,   L the mean emitted radiance and A the area of a sub-triangle
//
// An emitter is cut into congruent sub-triangles (shared/emit.h), with a point at the centroid of
// each.
//
// In:   emitters   `count` ClpvEmitter, `points` points in all
//       scale      number that volumes store for 1 W/sr
//       white      texture of materials without one
//       vertices, triangles, materials, textures, texels   the scene
// Out:  positions  [m]; normals: unit, on the emitting side; fluxes: P [W] times scale. `capacity`
//                  of each, for injection (find_cells.cl); those after the last point are empty.
// A work-item places a point. From the host: CLPV_TEXTURED, CLPV_MASKED.
#include "lanes.h"
#include "shared/emit.h"
#include "raster/texture.h"
#include "vec.h"


// Index of the emitter of a point: the last one whose first point is at or before it.
static inline uint find_emitter(__global const ClpvEmitter* emitters, const uint count,
                                const uint point) {
  uint low = 0, high = count - 1;
  while (low < high) {
    const uint middle = high - (high - low) / 2;
    if (emitters[middle].first <= point) {
      low = middle;
    } else {
      high = middle - 1;
    }
  }
  return low;
}

// Sub-triangle: its first corner and the length of its edges, in weights of the second and third
// corner of the triangle. Row r has 2 r + 1 of them; every second one is inverted and has negative
// edges.
typedef struct {
  float u, v, size;
} SubTriangle;

static inline SubTriangle find_sub_triangle(const ClpvEmitter emitter, const uint i) {
  uint row = (uint)sqrt((float)i);
  row -= row * row > i ? 1u : 0u;
  row += (row + 1u) * (row + 1u) <= i ? 1u : 0u;
  const uint along = i - row * row, column = along / 2, inverted = along % 2;
  const float step = emitter.size / (float)emitter.rows;
  const SubTriangle sub = {emitter.u + step * (float)(row - column),
                           emitter.v + step * (float)(column + inverted),
                           inverted != 0 ? -step : step};
  return sub;
}

// Mean emission of a material over a sub-triangle, relative to its emissive factor: from
// CLPV_EMIT_SAMPLES^2 samples of its texture and, if masked, its alpha.
CLPV_INLINE void mean_emission(const SubTriangle sub, __global const ClpvVertex* const corner[3],
                               __global const ClpvMaterial* material, const uint white,
                               __global const float4* textures, __global const uint* texels,
                               float mean[3]) {
  mean[0] = mean[1] = mean[2] = 1.0f;
  const bool masked = CLPV_MASKED && (material->flags & CLPV_MATERIAL_MASKED) != 0;
  if (material->emissive_texture == white && !masked) return;
  const float step = sub.size * (1.0f / CLPV_EMIT_SAMPLES), reach = CLPV_EMIT_FOOTPRINT * step;
  const float u1 = corner[1]->uv[0] - corner[0]->uv[0], v1 = corner[1]->uv[1] - corner[0]->uv[1];
  const float u2 = corner[2]->uv[0] - corner[0]->uv[0], v2 = corner[2]->uv[1] - corner[0]->uv[1];
  const Uv to_second = {(realW)(reach * u1), (realW)(reach * v1)};
  const Uv to_third = {(realW)(reach * u2), (realW)(reach * v2)};
  realW red = 0.0f, green = 0.0f, blue = 0.0f;
  for (int i = 0; i < CLPV_EMIT_SAMPLES * CLPV_EMIT_SAMPLES; i += W) {
    const realW at = (float)i + to_realW(lane_numbers());
    const realW row = to_realW(to_intW(sqrt(at + 0.5f)));
    const realW along = at - row * row;
    const realW column = to_realW(to_intW(0.5f * along)), inverted = along - 2.0f * column;
    const realW middle = (1.0f / 3.0f) * (1.0f - 2.0f * inverted);
    const Vec w = vec(ZERO, sub.u + step * (row - column + middle),
                      sub.v + step * (column + inverted + middle));  // the first is not used
    const Uv uv = {uv_at(w, corner, 0), uv_at(w, corner, 1)};
    Vec sample = vec(ONE, ONE, ONE);
    if (material->emissive_texture != white)
      sample_trilinear(textures, texels, (uintW)(material->emissive_texture), uv, to_second,
                       to_third, &sample);
    if (masked) {
      const realW alpha =
          material->base_colour[3] * colour_at(w, corner, 3) *
          sample_alpha(textures, texels, (uintW)(material->texture * CLPV_TEXTURE_LEVELS), uv);
      sample = vec_times(sample, alpha >= (realW)(material->alpha_cutoff) ? ONE : ZERO);
    }
    red += sample.x, green += sample.y, blue += sample.z;
  }
  const float each = 1.0f / (CLPV_EMIT_SAMPLES * CLPV_EMIT_SAMPLES);
  mean[0] = each * sum_lanes(red), mean[1] = each * sum_lanes(green),
  mean[2] = each * sum_lanes(blue);
}

__kernel void emit(__global const ClpvEmitter* emitters, const uint count, const uint points,
                   const uint capacity, const float scale, __global const ClpvVertex* vertices,
                   __global const ClpvTriangle* triangles, __global const ClpvMaterial* materials,
                   const uint white, __global const float4* textures, __global const uint* texels,
                   __global float4* positions, __global float4* normals, __global float4* fluxes) {
  const uint i = get_global_id(0);
  if (i >= capacity) return;
  positions[i] = normals[i] = fluxes[i] = (float4)(0.0f);
  if (i >= points) return;
  const ClpvEmitter emitter = emitters[find_emitter(emitters, count, i)];
  const ClpvTriangle triangle = triangles[emitter.triangle];
  __global const ClpvVertex* const corner[3] = {
      vertices + triangle.vertex[0], vertices + triangle.vertex[1], vertices + triangle.vertex[2]};
  __global const ClpvMaterial* material = materials + triangle.material;
  const SubTriangle sub = find_sub_triangle(emitter, i - emitter.first);
  const float w1 = sub.u + sub.size * (1.0f / 3.0f), w2 = sub.v + sub.size * (1.0f / 3.0f);
  float e1[3], e2[3], at[3];
  for (int a = 0; a < 3; ++a) {
    e1[a] = corner[1]->position[a] - corner[0]->position[a];
    e2[a] = corner[2]->position[a] - corner[0]->position[a];
    at[a] = corner[0]->position[a] + w1 * e1[a] + w2 * e2[a];
  }
  const float x = e1[1] * e2[2] - e1[2] * e2[1], y = e1[2] * e2[0] - e1[0] * e2[2],
              z = e1[0] * e2[1] - e1[1] * e2[0];
  const float twice = sqrt(x * x + y * y + z * z);  // twice the triangle's area
  if (!(twice > 0.0f)) return;
  float mean[3] = {1.0f, 1.0f, 1.0f};
  if (CLPV_TEXTURED || CLPV_MASKED)
    mean_emission(sub, corner, material, white, textures, texels, mean);
  const float flux = scale * (M_PI_F * 0.5f) * twice * (sub.size * sub.size),
              facing = emitter.side / twice;
  positions[i] = (float4)(at[0], at[1], at[2], 1.0f);
  normals[i] = (float4)(facing * x, facing * y, facing * z, 0.0f);
  fluxes[i] =
      (float4)(flux * mean[0] * material->emissive[0], flux * mean[1] * material->emissive[1],
               flux * mean[2] * material->emissive[2], 1.0f);
}
