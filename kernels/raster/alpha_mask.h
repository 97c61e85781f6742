// SPDX-License-Identifier: MIT
// Holes of masked materials: pixels whose alpha does not reach the material's cutoff.
#pragma once

#include "lanes.h"
#include "raster/texture.h"
#include "raster/triangle.h"

typedef struct {
  __global const ClpvVertex* vertices;
  __global const ClpvTriangle* triangles;
  __global const ClpvMaterial* materials;
  __global const float4* textures;
  __global const uint* texels;
} Scene;

// A triangle of a masked material: all that a look-up of its alpha needs.
typedef struct {
  Face face;
  Weights weights;
  Uv a, b, c;  // texture coordinates of the corners
  realW alpha_a, alpha_b, alpha_c;
  Level level;
  float base_alpha, cutoff;
} Mask;

CLPV_INLINE void load_mask_corner(__global const ClpvVertex* vertex, Vec* position, Uv* uv,
                                  realW* alpha) {
  *position = vec_load(vertex->position);
  uv->u = (realW)(vertex->uv[0]);
  uv->v = (realW)(vertex->uv[1]);
  *alpha = (realW)(vertex->colour[3]);
}

CLPV_INLINE void load_mask(const ClpvView view, const uint triangle, const Scene scene,
                           Mask* mask) {
  const ClpvTriangle t = scene.triangles[triangle];
  __global const ClpvMaterial* material = scene.materials + t.material;
  Vec a, b, c;
  load_mask_corner(scene.vertices + t.vertex[0], &a, &mask->a, &mask->alpha_a);
  load_mask_corner(scene.vertices + t.vertex[1], &b, &mask->b, &mask->alpha_b);
  load_mask_corner(scene.vertices + t.vertex[2], &c, &mask->c, &mask->alpha_c);
  mask->face = make_face(view, a, b, c);
  mask->weights = find_weights(mask->face);
  load_level_for_all(scene.textures, material->texture * CLPV_TEXTURE_LEVELS, &mask->level);
  mask->base_alpha = material->base_colour[3];
  mask->cutoff = material->alpha_cutoff;
}

// Mask of the pixels from (px, py) on whose alpha, at `depth` [m], reaches the cutoff: no hole.
CLPV_INLINE intW solid(const ClpvView view, const Mask* mask, const float px, const float py,
                       const realW depth, __global const uint* texels) {
  const realW x = px + to_realW(lane_numbers());
  const Vec w = weights_at(view, mask->face, mask->weights, x, (realW)(py), depth);
  const Uv uv = {interpolated(w, mask->a.u, mask->b.u, mask->c.u),
                 interpolated(w, mask->a.v, mask->b.v, mask->c.v)};
  const realW vertex_alpha = interpolated(w, mask->alpha_a, mask->alpha_b, mask->alpha_c);
  const realW alpha = mask->base_alpha * vertex_alpha *
                      sample_level_alpha(mask->level, texels, uv);
  return alpha >= mask->cutoff;
}
