// What each pixel sees, once rasterize.cl knows which triangle that is: depth, normal, and albedo or flux.
// One work-item a pixel, in the order of the tiles.
#include "lighting.h"
#include "shared/raster.h"
#include "texture.h"
#include "triangle.h"

// Where in a tile-ordered buffer's pixel i stands on the screen.
static inline int2 pixel_at(const uint i, const uint tiles_x) {
  const uint tile = i / (CLPV_TILE * CLPV_TILE), in_tile = i % (CLPV_TILE * CLPV_TILE);
  return (int2)((int)(tile % tiles_x * CLPV_TILE + in_tile % CLPV_TILE),
                (int)(tile / tiles_x * CLPV_TILE + in_tile / CLPV_TILE));
}

static inline float depth_of(const ClpvView view, const float key) {
  return fmax(CLPV_ORTHOGRAPHIC ? key : -1.0f / key, view.near_depth);
}

__kernel void resolve_depth(const ClpvView view, const uint tiles_x, const uint count,
                            __global const float* keys, __global float* depths) {
  const uint i = get_global_id(0);
  const int2 p = pixel_at(i, tiles_x);
  if (i >= count || p.x >= (int)view.width || p.y >= (int)view.height) return;
  depths[(uint)p.y * view.width + (uint)p.x] = isinf(keys[i]) ? 0.0f : depth_of(view, keys[i]);
}

typedef struct {
  float depth;    // [m]
  float3 normal;  // unit, on the viewer's side
  float3 albedo;
  float3 emissive;  // [W/m^2/sr]
} Seen;

static inline float2 blend2(const float3 w, const float2 a, const float2 b, const float2 c) {
  return w.x * a + w.y * b + w.z * c;
}

static inline float3 blend3(const float3 w, const float3 a, const float3 b, const float3 c) {
  return w.x * a + w.y * b + w.z * c;
}

// The surface of `triangle` behind pixel (px, py).
static inline Seen look(const ClpvView view, const float px, const float py, const float depth,
                        const uint triangle, __global const ClpvVertex* vertices,
                        __global const ClpvTriangle* triangles, __global const ClpvMaterial* materials,
                        __global const ClpvTexture* textures, __global const uchar4* texels) {
  const ClpvTriangle t = triangles[triangle];
  __global const ClpvVertex* a = vertices + t.vertex[0];
  __global const ClpvVertex* b = vertices + t.vertex[1];
  __global const ClpvVertex* c = vertices + t.vertex[2];
  __global const ClpvMaterial* material = materials + t.material;
  const Face face = clpv_face(view, vertices, t.vertex[0], t.vertex[1], t.vertex[2]);
  const Weights weights = clpv_weights(face);
  const float3 w = clpv_weights_at(view, face, weights, px, py, depth);
  const float2 screen = clpv_screen(view, px, py);
  const float3 ray =
      clpv_float3(view.forward) + (CLPV_ORTHOGRAPHIC ? (float3)(0.0f) : clpv_across(view, screen));

  Seen seen;
  seen.depth = depth;
  // The side comes from the triangle itself: near a silhouette an interpolated normal may point away from the
  // viewer.
  const float3 facing = dot(face.normal, ray) > 0.0f ? -face.normal : face.normal;
  float3 normal = blend3(w, vload3(0, a->normal), vload3(0, b->normal), vload3(0, c->normal));
  normal = dot(normal, facing) < 0.0f ? -normal : normal;
  seen.normal = normalize(dot(normal, normal) > 0.0f ? normal : facing);
  seen.albedo = vload3(0, material->base_colour) *
                blend3(w, vload3(0, a->colour), vload3(0, b->colour), vload3(0, c->colour));
  seen.emissive = vload3(0, material->emissive);
  if (material->texture == CLPV_NO_TEXTURE && material->emissive_texture == CLPV_NO_TEXTURE) return seen;

  // How far the hit moves on the plane from a pixel to the next one, hence uv.
  const float scale = CLPV_ORTHOGRAPHIC ? 1.0f : depth;
  const float3 right = clpv_float3(view.right) * (scale * clpv_step_x(view));
  const float3 down = clpv_float3(view.up) * (scale * clpv_step_y(view));
  const float3 along = ray / dot(face.normal, ray);
  const float3 x = right - along * dot(face.normal, right);
  const float3 y = down - along * dot(face.normal, down);
  const float2 uv_a = vload2(0, a->uv), uv_b = vload2(0, b->uv), uv_c = vload2(0, c->uv);
  const float2 uv = blend2(w, uv_a, uv_b, uv_c);
  const float2 uv_x = (uv_b - uv_a) * dot(x, weights.gradient1) + (uv_c - uv_a) * dot(x, weights.gradient2);
  const float2 uv_y = (uv_b - uv_a) * dot(y, weights.gradient1) + (uv_c - uv_a) * dot(y, weights.gradient2);
  if (material->texture != CLPV_NO_TEXTURE) {
    seen.albedo *= clpv_trilinear(textures, texels, material->texture, uv, uv_x, uv_y).xyz;
  }
  if (material->emissive_texture != CLPV_NO_TEXTURE) {
    seen.emissive *= clpv_trilinear(textures, texels, material->emissive_texture, uv, uv_x, uv_y).xyz;
  }
  return seen;
}

// `emissives` may be null.
__kernel void resolve_camera(const ClpvView view, const uint tiles_x, const uint count,
                             __global const float* keys, __global const uint* triangles_seen,
                             __global const ClpvVertex* vertices, __global const ClpvTriangle* triangles,
                             __global const ClpvMaterial* materials, __global const ClpvTexture* textures,
                             __global const uchar4* texels, __global float* depths,
                             __global SurfaceTexel* normals, __global SurfaceTexel* colours,
                             __global float4* emissives) {
  const uint i = get_global_id(0);
  const int2 p = pixel_at(i, tiles_x);
  if (i >= count || p.x >= (int)view.width || p.y >= (int)view.height) return;
  Seen seen = {0.0f, (float3)(0.0f), (float3)(0.0f), (float3)(0.0f)};
  if (triangles_seen[i] != UINT_MAX) {
    seen = look(view, (float)p.x, (float)p.y, depth_of(view, keys[i]), triangles_seen[i], vertices, triangles,
                materials, textures, texels);
  }
  const uint at = (uint)p.y * view.width + (uint)p.x;
  depths[at] = seen.depth;
  clpv_store_normal(normals, at, seen.normal);
  clpv_store_colour(colours, at, seen.albedo, 1.0f);
  if (emissives) emissives[at] = (float4)(seen.emissive, 0.0f);
}

// What the light sends through a pixel [W].
static inline float3 incident_flux(const ClpvView view, const ClpvLight light, const float px, const float py,
                                   const float depth) {
  float3 towards;
  return clpv_footprint(view, px, py, depth) *
         clpv_light_irradiance(light, clpv_position(view, px, py, depth), &towards);
}

// `colour_scale`: Surface::colour_scale.
__kernel void resolve_rsm(const ClpvView view, const ClpvLight light, const uint tiles_x, const uint count,
                          __global const float* keys, __global const uint* triangles_seen,
                          __global const ClpvVertex* vertices, __global const ClpvTriangle* triangles,
                          __global const ClpvMaterial* materials, __global const ClpvTexture* textures,
                          __global const uchar4* texels, __global float* depths,
                          __global SurfaceTexel* normals, __global SurfaceTexel* fluxes,
                          const float colour_scale) {
  const uint i = get_global_id(0);
  const int2 p = pixel_at(i, tiles_x);
  if (i >= count || p.x >= (int)view.width || p.y >= (int)view.height) return;
  Seen seen = {0.0f, (float3)(0.0f), (float3)(0.0f), (float3)(0.0f)};
  if (triangles_seen[i] != UINT_MAX) {
    const float depth = depth_of(view, keys[i]);
    seen = look(view, (float)p.x, (float)p.y, depth, triangles_seen[i], vertices, triangles, materials,
                textures, texels);
    seen.albedo *= incident_flux(view, light, (float)p.x, (float)p.y, depth);
  }
  const uint at = (uint)p.y * view.width + (uint)p.x;
  depths[at] = seen.depth;
  clpv_store_normal(normals, at, seen.normal);
  clpv_store_colour(fluxes, at, seen.albedo, colour_scale);
}
