// SPDX-License-Identifier: MIT
// Radiance of the surfaces that rays of the near field hit, towards the rays' origins.
//
//   L_hit = L_emitted + albedo / pi (E_direct + E_volume)      [W/m^2/sr]; E_volume only with more than one bounce
//
// All surfaces reflect on both sides; emissive ones emit from the front, and from the back if double sided. Textures are
// filtered over the width of a ray's cone, CLPV_NEAR_CONE times its length. A ray that leaves below the plane of its own
// triangle, where the interpolated normal differs from the triangle's, carries no light.
//
// In:      points, directions, distances, places   near_layout.h, near_trace.cl
//          CLPV_SCENE          the scene
//          fresh               1: overwrite `radiances`; 0: add to them
//   near_light:   light, views, count, which, map   a light and one of its shadow maps (shadow.h)
//   near_reflect: CLPV_RADIANCE                     volumes (radiance.h)
// In, out: radiances           three planes for each k
// A work-item processes the rays k of eight pixels of a row. From the host: CLPV_TEXTURED, CLPV_COLOURED, CLPV_EMISSIVE,
// CLPV_NEAR_CONE, and with CLPV_NEAR_REFLECT 1 what radiance.h needs.
#include "near_layout.h"
#include "scene_triangles.h"
#include "shadow.h"
#include "tile_row.h"
#if CLPV_NEAR_REFLECT
#include "radiance.h"
#endif

typedef struct {
  int8 hit;
  Vec position, normal;  // [m]; unit, towards the ray's origin
  Vec albedo, emitted;   // [W/m^2/sr]
} HitSurface;

// The surfaces that rays k hit.
CLPV_INLINE void hit_surfaces(const NearRow r, const uint k, __global const float* points,
                              __global const float8* directions, __global const float* distances,
                              __global const float* places, CLPV_SCENE, HitSurface* s) {
  NearPoints p;
  near_points_at(points, r, &p);
  const float8 none = (float8)(0.0f), distance = vload8(0, distances + k * r.plane + r.at);
  const Vec place = near_vectors(places + 3 * k * r.plane, r.plane, r.at);
  s->hit = (p.reach > none) & (distance < (float8)(INFINITY));
  const Vec along = near_directions(directions, r, &p, k);
  Rows indices;
  gather_rows(triangles, as_uint8(place.z), &indices);
  VertexAttributes a, b, c;
  corner_at(vertices, as_uint8(CLPV_COLUMN(indices, x)), &a);
  corner_at(vertices, as_uint8(CLPV_COLUMN(indices, y)), &b);
  corner_at(vertices, as_uint8(CLPV_COLUMN(indices, z)), &c);
  MaterialLanes material;
  material_of(materials, as_uint8(CLPV_COLUMN(indices, w)), &material);
  const Vec w = vec(1.0f - place.x - place.y, place.x, place.y);
  const Vec edge1 = vec_minus(b.position, a.position), edge2 = vec_minus(c.position, a.position);
  const Vec across = vec_cross(edge1, edge2);
  const float8 area2 = sqrt(vec_dot(across, across)), facing = vec_dot(across, along);
  const int8 back = facing > none;
  // Rays start CLPV_NEAR_LIFT R above their own triangle.
  const Vec to_origin = vec_minus(p.position, a.position);
  s->hit &= fabs(vec_dot(to_origin, across)) > 2.0f * CLPV_NEAR_LIFT * p.reach * area2;
  s->position = vec_blend(w, a.position, b.position, c.position);
  s->normal = normal_towards(vec_times(across, back ? (float8)(-1.0f) : (float8)(1.0f)),
                             vec_blend(w, a.normal, b.normal, c.normal));
  s->albedo = material.base_colour;
#if CLPV_COLOURED
  s->albedo = vec_product(s->albedo, vec_blend(w, a.colour, b.colour, c.colour));
#endif
#if CLPV_EMISSIVE
  const int8 emits = ~back | ((material.flags & CLPV_MATERIAL_DOUBLE_SIDED) != 0u);
  s->emitted = vec_masked(emits, material.emissive);
#else
  s->emitted = vec(none, none, none);
#endif
#if CLPV_TEXTURED
  const Uv uv1 = {b.uv.u - a.uv.u, b.uv.v - a.uv.v}, uv2 = {c.uv.u - a.uv.u, c.uv.v - a.uv.v};
  const Uv uv = {a.uv.u + w.y * uv1.u + w.z * uv2.u, a.uv.v + w.y * uv1.v + w.z * uv2.v};
  const float8 uv_area2 = fabs(uv1.u * uv2.v - uv1.v * uv2.u);
  const float8 step = distance * CLPV_NEAR_CONE * sqrt(uv_area2 / area2);
  const Uv step_x = {step, none}, step_y = {none, step};
  apply_texture(textures, texels, material.texture, uv, step_x, step_y, &s->albedo);
#if CLPV_EMISSIVE
  apply_texture(textures, texels, material.emissive_texture, uv, step_x, step_y, &s->emitted);
#endif
#endif
}

CLPV_INLINE void add_radiance(const NearRow r, const uint k, const int8 hit, Vec radiance, const uint fresh,
                              __global float* radiances) {
  radiances += 3 * k * r.plane;
  radiance = vec_masked(hit, radiance);
  if (!fresh) radiance = vec_add_scaled(radiance, (float8)(1.0f), near_vectors(radiances, r.plane, r.at));
  store_near_vectors(radiance, radiances, r.plane, r.at);
}

#define CLPV_NEAR_HITS                                                                                              \
  const ClpvView view, __global const float *points, __global const float8 *directions,                            \
      __global const float *distances, __global const float *places, CLPV_SCENE, const uint fresh,                  \
      __global float *radiances

#if !CLPV_NEAR_REFLECT

__kernel void near_light(CLPV_NEAR_HITS, const ClpvLight light, __global const ClpvView* views, const uint count,
                         const uint which, __global const float* map) {
  const NearRow r = near_row(view, get_global_id(0), get_global_id(1));
  const uint k = get_global_id(2);
  if (!near_inside(r)) return;
  HitSurface s;
  hit_surfaces(r, k, points, directions, distances, places, CLPV_PASS_SCENE, &s);
  const ShadowMap shadow = {views, count, which, map};
  int8 lit = s.hit;
  const Vec irradiance = clpv_shadowed_irradiance(light, shadow, s.position, s.normal, &lit);
  add_radiance(r, k, lit, vec_times(vec_product(s.albedo, irradiance), (float8)(M_1_PI_F)), fresh, radiances);
}

__kernel void near_emit(CLPV_NEAR_HITS) {
  const NearRow r = near_row(view, get_global_id(0), get_global_id(1));
  const uint k = get_global_id(2);
  if (!near_inside(r)) return;
  HitSurface s;
  hit_surfaces(r, k, points, directions, distances, places, CLPV_PASS_SCENE, &s);
  add_radiance(r, k, s.hit, s.emitted, fresh, radiances);
}

#else

__kernel void near_reflect(CLPV_NEAR_HITS, CLPV_RADIANCE) {
  const NearRow r = near_row(view, get_global_id(0), get_global_id(1));
  const uint k = get_global_id(2);
  if (!near_inside(r)) return;
  HitSurface s;
  hit_surfaces(r, k, points, directions, distances, places, CLPV_PASS_SCENE, &s);
  RadianceField field;
  clpv_radiance_field(CLPV_PASS_RADIANCE, s.position, (float8)(CLPV_GATHER_OFFSET), s.normal, s.hit, &field);
  const VecLanes n = unpack(s.hit, s.normal);
  float x[CLPV_ABREAST], y[CLPV_ABREAST], z[CLPV_ABREAST];
  for (int i = 0; i < CLPV_ABREAST; ++i) {
    const float4 e = clpv_field_irradiance(&field.at[i], n.x[i], n.y[i], n.z[i]);
    x[i] = e.x, y[i] = e.y, z[i] = e.z;
  }
  const Vec irradiance = vec(vload8(0, x), vload8(0, y), vload8(0, z));
  add_radiance(r, k, s.hit, vec_times(vec_product(s.albedo, irradiance), (float8)(M_1_PI_F)), fresh, radiances);
}

#endif
