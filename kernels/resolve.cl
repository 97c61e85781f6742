// What each pixel sees, once rasterize.cl knows which triangle that is: depth, normal, and albedo or flux.
// One work-item a pixel. Selections instead of branches: a pixel that sees nothing looks at triangle 0 and forgets
// it, a material without texture looks at a white texel.
//
// From the host: CLPV_ORTHOGRAPHIC, CLPV_SURFACE_PAPER, and what the scene needs of CLPV_TEXTURED (any texture at
// all), CLPV_COLOURED (vertex colours other than 1), CLPV_EMISSIVE (materials that emit); CLPV_WHITE_TEXTURE, the
// texture of materials that have none.
#include "lighting.h"
#include "shared/raster.h"
#include "texture.h"
#include "triangle.h"

#ifndef CLPV_TEXTURED
#define CLPV_TEXTURED 1
#define CLPV_COLOURED 1
#define CLPV_EMISSIVE 1
#define CLPV_WHITE_TEXTURE 0
#endif

// Where the tile-ordered buffers of rasterize.cl hold a pixel.
static inline uint in_tiles(const uint px, const uint py, const uint tiles_x) {
  const uint tile = py / CLPV_TILE * tiles_x + px / CLPV_TILE;
  return tile * (CLPV_TILE * CLPV_TILE) + py % CLPV_TILE * CLPV_TILE + px % CLPV_TILE;
}

// The depth of the surface hit, which may lie before the near depth; unset where there is none.
static inline float hit_depth(const float key) {
  return CLPV_ORTHOGRAPHIC ? key : -1.0f / key;
}

// The depth to store; 0 where there is no surface.
static inline float seen_depth(const ClpvView view, const float key) {
  const float depth = hit_depth(key);
  return key == INFINITY ? 0.0f : depth > view.near_depth ? depth : view.near_depth;
}

__kernel void resolve_depth(const ClpvView view, const uint tiles_x, __global const float* keys,
                            __global float* depths) {
  const uint px = get_global_id(0), py = get_global_id(1);
  if (px >= view.width || py >= view.height) return;
  depths[py * view.width + px] = seen_depth(view, keys[in_tiles(px, py, tiles_x)]);
}

typedef struct {
  Vec normal;  // unit, on the viewer's side
  Vec albedo;
  Vec emissive;  // [W/m^2/sr]
} Seen;

// How far uv moves on a face when its point moves by `by` from pixel to pixel across the view.
static inline Uv uv_step(const Face face, const Weights weights, const Vec along, const Vec by, const Uv uv1,
                         const Uv uv2) {
  const Vec on_face = vec_add_scaled(by, -vec_dot(face.normal, by), along);
  const float w1 = vec_dot(on_face, weights.gradient1), w2 = vec_dot(on_face, weights.gradient2);
  const Uv step = {w1 * uv1.u + w2 * uv2.u, w1 * uv1.v + w2 * uv2.v};
  return step;
}

static inline Vec texture_or_white(__global const ClpvTexture* textures, __global const uint* texels,
                                   const uint texture, const float u, const float v, const Uv step_x,
                                   const Uv step_y) {
  return clpv_trilinear(textures, texels, texture == CLPV_NO_TEXTURE ? CLPV_WHITE_TEXTURE : texture, u, v,
                        step_x, step_y);
}

// The surface of `triangle` behind pixel (px, py).
CLPV_INLINE Seen look(const ClpvView view, const float px, const float py, const float depth,
                      const uint triangle, __global const ClpvVertex* vertices,
                      __global const ClpvTriangle* triangles, __global const ClpvMaterial* materials,
                      __global const ClpvTexture* textures, __global const uint* texels) {
  __global const ClpvVertex* a = vertices + triangles[triangle].vertex[0];
  __global const ClpvVertex* b = vertices + triangles[triangle].vertex[1];
  __global const ClpvVertex* c = vertices + triangles[triangle].vertex[2];
  __global const ClpvMaterial* material = materials + triangles[triangle].material;
  const Face face = clpv_face(view, a, b, c);
  const Weights weights = clpv_weights(face);
  const Vec w = clpv_weights_at(view, face, weights, px, py, depth);
  const Vec ray = clpv_along(view, px, py);
  const float facing = vec_dot(face.normal, ray);

  Seen seen;
  // The side comes from the triangle itself: near a silhouette an interpolated normal may point away from the viewer.
  const Vec front = vec_times(face.normal, facing > 0.0f ? -1.0f : 1.0f);
  const Vec blended = vec_blend(w, vec_load(a->normal), vec_load(b->normal), vec_load(c->normal));
  const bool usable = vec_dot(blended, blended) > 0.0f;
  const Vec normal =
      vec(usable ? blended.x : front.x, usable ? blended.y : front.y, usable ? blended.z : front.z);
  const float length2 = vec_dot(normal, normal);
  seen.normal = vec_times(normal, (vec_dot(normal, front) < 0.0f ? -1.0f : 1.0f) / sqrt(length2));
  seen.albedo = vec_load(material->base_colour);
  seen.emissive = vec_load(material->emissive);
#if CLPV_COLOURED
  seen.albedo =
      vec_product(seen.albedo, vec_blend(w, vec_load(a->colour), vec_load(b->colour), vec_load(c->colour)));
#endif
#if CLPV_TEXTURED
  const Uv uv1 = {b->uv[0] - a->uv[0], b->uv[1] - a->uv[1]};
  const Uv uv2 = {c->uv[0] - a->uv[0], c->uv[1] - a->uv[1]};
  const float u = a->uv[0] + w.y * uv1.u + w.z * uv2.u, v = a->uv[1] + w.y * uv1.v + w.z * uv2.v;
  const float scale = CLPV_ORTHOGRAPHIC ? 1.0f : depth;
  const Vec along = vec_times(ray, 1.0f / facing);
  const Uv step_x =
      uv_step(face, weights, along, vec_times(vec_of(view.right), scale * clpv_step_x(view)), uv1, uv2);
  const Uv step_y =
      uv_step(face, weights, along, vec_times(vec_of(view.up), scale * clpv_step_y(view)), uv1, uv2);
  seen.albedo =
      vec_product(seen.albedo, texture_or_white(textures, texels, material->texture, u, v, step_x, step_y));
#if CLPV_EMISSIVE
  seen.emissive = vec_product(
      seen.emissive, texture_or_white(textures, texels, material->emissive_texture, u, v, step_x, step_y));
#endif
#endif
  return seen;
}

#define CLPV_SCENE                                                                  \
  __global const ClpvVertex *vertices, __global const ClpvTriangle *triangles,      \
      __global const ClpvMaterial *materials, __global const ClpvTexture *textures, \
      __global const uint *texels
#define CLPV_PASS_SCENE vertices, triangles, materials, textures, texels

// Emission goes to `emissives` where CLPV_EMISSIVE; a scene that does not emit has none to write.
__kernel void resolve_camera(const ClpvView view, const uint tiles_x, __global const float* keys,
                             __global const uint* triangles_seen, CLPV_SCENE, __global float* depths,
                             __global SurfaceTexel* normals, __global SurfaceTexel* colours
#if CLPV_EMISSIVE
                             ,
                             __global float* emissives
#endif
) {
  const uint px = get_global_id(0), py = get_global_id(1);
  if (px >= view.width || py >= view.height) return;
  const uint at = in_tiles(px, py, tiles_x), pixel = py * view.width + px;
  const float depth = seen_depth(view, keys[at]);
  const bool hit = triangles_seen[at] != UINT_MAX;
  const Seen seen =
      look(view, (float)px, (float)py, hit_depth(keys[at]), hit ? triangles_seen[at] : 0, CLPV_PASS_SCENE);
  depths[pixel] = depth;
  const Vec normal = vec_if(hit, seen.normal);
  clpv_store_normal(normals, pixel, normal.x, normal.y, normal.z);
  const Vec albedo = vec_if(hit, seen.albedo);
  clpv_store_colour(colours, pixel, albedo.x, albedo.y, albedo.z, 1.0f);
#if CLPV_EMISSIVE
  const Vec emissive = vec_if(hit, seen.emissive);
  emissives[4 * pixel] = emissive.x;
  emissives[4 * pixel + 1] = emissive.y;
  emissives[4 * pixel + 2] = emissive.z;
  emissives[4 * pixel + 3] = 0.0f;
#endif
}

// `colour_scale`: Surface::colour_scale.
__kernel void resolve_rsm(const ClpvView view, const ClpvLight light, const uint tiles_x,
                          __global const float* keys, __global const uint* triangles_seen, CLPV_SCENE,
                          __global float* depths, __global SurfaceTexel* normals,
                          __global SurfaceTexel* fluxes, const float colour_scale) {
  const uint px = get_global_id(0), py = get_global_id(1);
  if (px >= view.width || py >= view.height) return;
  const uint at = in_tiles(px, py, tiles_x), pixel = py * view.width + px;
  const float depth = seen_depth(view, keys[at]);
  const bool hit = triangles_seen[at] != UINT_MAX;
  const Seen seen =
      look(view, (float)px, (float)py, hit_depth(keys[at]), hit ? triangles_seen[at] : 0, CLPV_PASS_SCENE);
  float3 towards;
  const float3 irradiance =
      clpv_light_irradiance(light, clpv_position(view, (float)px, (float)py, depth), &towards);
  const Vec incident = vec_times(vec(irradiance.x, irradiance.y, irradiance.z),
                                 clpv_footprint(view, (float)px, (float)py, depth));
  const Vec flux = vec_if(hit, vec_product(seen.albedo, incident));
  depths[pixel] = depth;
  const Vec normal = vec_if(hit, seen.normal);
  clpv_store_normal(normals, pixel, normal.x, normal.y, normal.z);
  clpv_store_colour(fluxes, pixel, flux.x, flux.y, flux.z, colour_scale);
}
