// SPDX-License-Identifier: MIT
// Attributes of W triangles of the scene: corners, materials and textures (shared/mesh.h).
//
// From the host: CLPV_COLOURED (vertex colours other than 1) and CLPV_EMISSIVE (emissive
// materials).
#pragma once

#include "lanes.h"
#include "raster/texture.h"
#include "shared/normal.h"
#include "vec.h"

// Parameters of the scene's buffers, in rows of float4.
#define CLPV_SCENE                                                       \
  __global const float4 *vertices, __global const float4 *triangles,     \
      __global const float4 *materials, __global const float4 *textures, \
      __global const uint *texels
#define CLPV_PASS_SCENE vertices, triangles, materials, textures, texels

// Loads a row per lane or, if `same_triangle` (a literal), one row for all lanes.
CLPV_INLINE void load_rows(__global const float4* from, const uintW at, const bool same_triangle,
                           Rows* rows) {
  if (same_triangle) {
    spread_row(from, first_lane(at), rows);
  } else {
    gather_rows(from, at, rows);
  }
}

// Attributes of one corner of each lane's triangle.
typedef struct {
  Vec position, normal;
  Uv uv;
  Vec colour;
} VertexAttributes;

CLPV_INLINE void load_corner(__global const float4* vertices, const uintW index,
                             const bool same_triangle, VertexAttributes* corner) {
  Rows first, second;
  const uintW row = CLPV_VERTEX_ROWS * index;
  load_rows(vertices + CLPV_VERTEX_POSITION, row, same_triangle, &first);
  load_rows(vertices + CLPV_VERTEX_UV, row, same_triangle, &second);
  corner->position = vec(CLPV_COLUMN(first, x), CLPV_COLUMN(first, y), CLPV_COLUMN(first, z));
  corner->normal = vec(CLPV_COLUMN(first, w), CLPV_COLUMN(second, x), CLPV_COLUMN(second, y));
  corner->uv.u = CLPV_COLUMN(second, z);
  corner->uv.v = CLPV_COLUMN(second, w);
  if (!CLPV_COLOURED) return;
  Rows third;
  load_rows(vertices + CLPV_VERTEX_COLOUR, row, same_triangle, &third);
  corner->colour = vec(CLPV_COLUMN(third, x), CLPV_COLUMN(third, y), CLPV_COLUMN(third, z));
}

typedef struct {
  Vec base_colour, emissive;
  uintW texture, emissive_texture, flags;
} MaterialLanes;

CLPV_INLINE void load_material(__global const float4* materials, const uintW index,
                               const bool same_triangle, MaterialLanes* material) {
  Rows base, textures;
  const uintW row = CLPV_MATERIAL_ROWS * index;
  load_rows(materials + CLPV_MATERIAL_COLOUR, row, same_triangle, &base);
  load_rows(materials + CLPV_MATERIAL_TEXTURES, row, same_triangle, &textures);
  material->base_colour = vec(CLPV_COLUMN(base, x), CLPV_COLUMN(base, y), CLPV_COLUMN(base, z));
  material->texture = as_uintW(CLPV_COLUMN(textures, x));
  material->flags = as_uintW(CLPV_COLUMN(textures, z));
  if (!CLPV_EMISSIVE) return;
  Rows emissive;
  load_rows(materials + CLPV_MATERIAL_EMISSIVE, row, same_triangle, &emissive);
  material->emissive =
      vec(CLPV_COLUMN(emissive, x), CLPV_COLUMN(emissive, y), CLPV_COLUMN(emissive, z));
  material->emissive_texture = as_uintW(CLPV_COLUMN(textures, y));
}

// W triangles of the scene.
typedef struct {
  VertexAttributes a, b, c;
  MaterialLanes material;
} TriangleLanes;

// `same_triangle`: all lanes have the same triangle.
CLPV_INLINE void load_triangles(CLPV_SCENE, const uintW number, const bool same_triangle,
                                TriangleLanes* t) {
  Rows indices;
  load_rows(triangles, number, same_triangle, &indices);
  load_corner(vertices, as_uintW(CLPV_COLUMN(indices, x)), same_triangle, &t->a);
  load_corner(vertices, as_uintW(CLPV_COLUMN(indices, y)), same_triangle, &t->b);
  load_corner(vertices, as_uintW(CLPV_COLUMN(indices, z)), same_triangle, &t->c);
  load_material(materials, as_uintW(CLPV_COLUMN(indices, w)), same_triangle, &t->material);
}

// Interpolated normal of length 1, flipped to the side of `front`. Near a silhouette the
// interpolated normal itself may point to the other side.
static inline Vec normal_towards(const Vec front, const Vec interpolated) {
  const intW usable = vec_dot(interpolated, interpolated) > ZERO;
  const Vec normal = vec(usable ? interpolated.x : front.x, usable ? interpolated.y : front.y,
                         usable ? interpolated.z : front.z);
  return vec_times(normal,
                   (vec_dot(normal, front) < ZERO ? -ONE : ONE) / sqrt(vec_dot(normal, normal)));
}

// Unit normal along `front`; `shading` where both are one, and for triangles without area.
static inline Vec geometric_towards(const Vec front, const Vec shading) {
  const realW square = vec_dot(front, front);
  const Vec unit = vec_times(front, square > ZERO ? ONE / sqrt(square) : ZERO);
  const intW apart = (square > ZERO) & (vec_dot(unit, shading) <= (realW)(CLPV_SAME_NORMAL));
  return (Vec){apart ? unit.x : shading.x, apart ? unit.y : shading.y, apart ? unit.z : shading.z};
}

CLPV_INLINE void apply_texture(__global const float4* textures, __global const uint* texels,
                               const uintW texture, const Uv uv, const Uv step_x, const Uv step_y,
                               Vec* colour) {
  Vec factor;
  sample_trilinear(textures, texels, texture, uv, step_x, step_y, &factor);
  *colour = vec_product(*colour, factor);
}

// A point of W triangles.
typedef struct {
  Vec normal, geometric;  // unit, towards the viewer: interpolated, and of the triangle
  Vec albedo;
  Vec emissive;  // [W/m^2/sr]; only with CLPV_EMISSIVE
} SurfaceLanes;

// The surface at weights `w` of the corners, without textures. `front`: normal towards the viewer.
CLPV_INLINE void surface_at(const TriangleLanes* t, const Vec w, const Vec front,
                            SurfaceLanes* s) {
  s->normal =
      normal_towards(front, vec_interpolated(w, t->a.normal, t->b.normal, t->c.normal));
  s->geometric = geometric_towards(front, s->normal);
  s->albedo = t->material.base_colour;
  if (CLPV_EMISSIVE) s->emissive = t->material.emissive;
  if (CLPV_COLOURED)
    s->albedo =
        vec_product(s->albedo, vec_interpolated(w, t->a.colour, t->b.colour, t->c.colour));
}

// Change of uv from the first corner to the second or third one.
static inline Uv uv_edge(const VertexAttributes from, const VertexAttributes to) {
  return (Uv){to.uv.u - from.uv.u, to.uv.v - from.uv.v};
}

static inline Uv uv_along(const realW w1, const realW w2, const Uv uv1, const Uv uv2) {
  return (Uv){w1 * uv1.u + w2 * uv2.u, w1 * uv1.v + w2 * uv2.v};
}

// Multiplies the surface by its textures at weights `w`, filtered over two steps of uv.
CLPV_INLINE void apply_textures(__global const float4* textures, __global const uint* texels,
                                const TriangleLanes* t, const Vec w, const Uv step_x,
                                const Uv step_y, SurfaceLanes* s) {
  const Uv uv1 = uv_edge(t->a, t->b), uv2 = uv_edge(t->a, t->c);
  const Uv uv = {t->a.uv.u + w.y * uv1.u + w.z * uv2.u, t->a.uv.v + w.y * uv1.v + w.z * uv2.v};
  apply_texture(textures, texels, t->material.texture, uv, step_x, step_y, &s->albedo);
  if (CLPV_EMISSIVE)
    apply_texture(textures, texels, t->material.emissive_texture, uv, step_x, step_y,
                  &s->emissive);
}
