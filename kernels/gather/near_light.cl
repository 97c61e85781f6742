// SPDX-License-Identifier: MIT
// Radiance of the surfaces that rays of the near field hit, towards the rays' origins.
//
//   L_hit = L_emitted + albedo / pi (E_direct + E_volume)      [W/m^2/sr]; E_volume only with more
//                                                              than one bounce
//
// All surfaces reflect on both sides; emissive ones emit from the front, and from the back if
// double sided. Textures are filtered over the width of a ray's cone, CLPV_NEAR_CONE times its
// length. A ray about the interpolated normal may point below its own triangle and hit it; such a
// hit counts as dark.
//
// In:      points, counts, hits   near_layout.h, near_trace.cl
//          CLPV_SCENE          the scene
//          fresh               1: overwrite `radiances`; 0: add to them
//   near_light:   light, views, count, which, map   a light and one of its shadow maps (shadow.h)
//   near_reflect: CLPV_RADIANCE                     volumes (radiance.h)
// In, out: radiances           three planes for each k, of the rays that hit
// A work-item processes W hits of a tile. From the host: CLPV_TEXTURED, CLPV_COLOURED,
// CLPV_EMISSIVE, CLPV_NEAR_CONE, and with CLPV_NEAR_REFLECT 1 what radiance.h needs.
#include "gather/near_layout.h"
#include "raster/scene_triangles.h"
#include "raster/shadow.h"
#include "raster/surface_row.h"
#include "raster/tile_row.h"
#if CLPV_NEAR_REFLECT
#include "gather/radiance.h"
#endif

typedef struct {
  intW hit;
  uintW radiance;        // place among the radiances
  Vec position;          // [m]
  Vec clear;             // way [m] to the point a cell from the ray's origin towards the eye, or 0
  SurfaceLanes surface;  // towards the ray's origin
} HitSurface;

// Number of a tile's hits from this work-item's first one on.
static inline uint hits_left(const ClpvView view, __global const uint* counts) {
  const uint tile = find_near_tile(view), first = W > 1 ? get_global_id(2) * W : 0;
  if (tile == no_tile) return 0;
  const uint count = counts[count_index(tile)];
  return count > first ? count - first : 0;
}

// The surfaces of this work-item's hits. Returns false if there are none.
CLPV_INLINE bool load_hit_surfaces(const ClpvView view, __global const float* points,
                                   __global const uint* counts, __global const realW* hits,
                                   CLPV_SCENE, HitSurface* s) {
  const uint left = hits_left(view, counts);
  if (left == 0) return false;
  hits += (find_near_tile(view) * CLPV_TILE_HITS / W + get_global_id(2)) * CLPV_HIT_ROWS;
  const intW listed = lane_numbers() < (intW)((int)left);
  const realW u = listed ? hits[CLPV_HIT_U] : ZERO, v = listed ? hits[CLPV_HIT_V] : ZERO,
               distance = listed ? hits[CLPV_HIT_DISTANCE] : ZERO;
  const uintW zero = (uintW)(0u), triangle = listed ? as_uintW(hits[CLPV_HIT_TRIANGLE]) : zero,
              pixel = listed ? as_uintW(hits[CLPV_HIT_PIXEL]) : zero;
  s->radiance = as_uintW(hits[CLPV_HIT_RADIANCE]);
  const uint plane = plane_size(view);
  const Vec origin =
      vec((realW)CLPV_GATHER(points, pixel), (realW)CLPV_GATHER(points, pixel + plane),
          (realW)CLPV_GATHER(points, pixel + 2 * plane));
  const realW reach = (realW)CLPV_GATHER(points + CLPV_NEAR_REACH * plane, pixel);
  TriangleLanes t;
  load_triangles(CLPV_PASS_SCENE, triangle, false, &t);
  const Vec at = t.a.position, w = vec(1.0f - u - v, u, v);
  const Vec across = vec_cross(vec_minus(t.b.position, at), vec_minus(t.c.position, at));
  const realW area2 = sqrt(vec_dot(across, across)),
              height = vec_dot(vec_minus(origin, at), across);
  const intW back = height < ZERO;
  // Leaves out hits on the ray's own triangle: its plane holds the pixel that the ray starts from.
  s->hit = listed & (fabs(height) > 2.0f * CLPV_NEAR_LIFT * reach * area2);
  s->position = vec_interpolated(w, at, t.b.position, t.c.position);
  const Vec eye = towards_eye(view, origin);
  const realW far = sqrt(vec_dot(eye, eye)), part = far > reach ? reach / far : ONE;
  s->clear = vec_masked(far > ZERO, vec_minus(vec_add_scaled(origin, part, eye), s->position));
  const Vec front = vec_times(across, back ? (realW)(-1.0f) : ONE);
  surface_at(&t, w, front, &s->surface);
  const intW emits = (back == 0) | ((t.material.flags & CLPV_MATERIAL_DOUBLE_SIDED) != 0u);
  if (CLPV_EMISSIVE) s->surface.emissive = vec_masked(emits, s->surface.emissive);
  if (!CLPV_TEXTURED) return true;
  const Uv uv1 = uv_edge(t.a, t.b), uv2 = uv_edge(t.a, t.c);
  const realW uv_area2 = fabs(uv1.u * uv2.v - uv1.v * uv2.u);
  const realW step = distance * CLPV_NEAR_CONE * sqrt(uv_area2 / area2);
  const Uv step_x = {step, ZERO}, step_y = {ZERO, step};
  apply_textures(textures, texels, &t, w, step_x, step_y, &s->surface);
  return true;
}

static inline Vec reflected(const HitSurface s, const Vec irradiance) {
  return vec_times(vec_product(s.surface.albedo, irradiance), (realW)(M_1_PI_F));
}

// Adds radiance, 0 outside the mask `lit`.
CLPV_INLINE void add_radiance(const ClpvView view, const HitSurface s, const intW lit,
                              const Vec radiance, const uint fresh, __global const uint* counts,
                              __global float* radiances) {
  const uint plane = plane_size(view), left = hits_left(view, counts);
  const VecLanes added = unpack(lit, radiance);
  uint at[W];
  store_lanes(s.radiance, at);
  for (uint i = 0; i < min(left, (uint)W); ++i) {
    __global float* to = radiances + at[i];
    to[0] = fresh ? added.x[i] : to[0] + added.x[i];
    to[plane] = fresh ? added.y[i] : to[plane] + added.y[i];
    to[2 * plane] = fresh ? added.z[i] : to[2 * plane] + added.z[i];
  }
}

#define CLPV_NEAR_HITS                                                            \
  const ClpvView view, __global const float *points, __global const uint *counts, \
      __global const realW *hits, CLPV_SCENE, const uint fresh, __global float *radiances
#define CLPV_PASS_HITS view, points, counts, hits, CLPV_PASS_SCENE

#if !CLPV_NEAR_REFLECT

__kernel void near_light(CLPV_NEAR_HITS, const ClpvLight light, __global const ClpvView* views,
                         const uint count, const uint which, __global const float* map) {
  HitSurface s;
  if (!load_hit_surfaces(CLPV_PASS_HITS, &s)) return;
  const ShadowMap shadow = {views, count, which, map};
  intW lit = s.hit;
  const Vec irradiance =
      shadowed_irradiance(light, shadow, s.position, s.surface.normal, s.surface.geometric, &lit);
  add_radiance(view, s, lit, reflected(s, irradiance), fresh, counts, radiances);
}

__kernel void near_emit(CLPV_NEAR_HITS) {
  HitSurface s;
  if (load_hit_surfaces(CLPV_PASS_HITS, &s))
    add_radiance(view, s, s.hit, s.surface.emissive, fresh, counts, radiances);
}

#else

__kernel void near_reflect(CLPV_NEAR_HITS, CLPV_RADIANCE) {
  HitSurface s;
  if (!load_hit_surfaces(CLPV_PASS_HITS, &s)) return;
  RadianceField field;
  const Vec lift = lift_normal(s.surface.geometric, s.surface.normal);
  sample_radiance(CLPV_PASS_RADIANCE, s.position, (realW)(CLPV_GATHER_OFFSET), lift,
                  s.clear, s.clear, s.hit, &field);
  const VecLanes n = unpack(s.hit, s.surface.normal);
  float x[W], y[W], z[W];
  for (int i = 0; i < W; ++i) {
    const float4 e = field_irradiance(&field.at[i], n.x[i], n.y[i], n.z[i]);
    x[i] = e.x, y[i] = e.y, z[i] = e.z;
  }
  const Vec irradiance = vec(load_lanes(x), load_lanes(y), load_lanes(z));
  add_radiance(view, s, s.hit, reflected(s, irradiance), fresh, counts, radiances);
}

#endif
