// SPDX-License-Identifier: MIT
// Light that a medium scatters towards the camera (docs/method.md, 'Media').
//
//   L = T(eye, x) L_surface(x) + integral of T(eye, p) S(p) dt      [W/m^2/sr]
//   S(p) = sigma_s [sum_lights p(w_light, w) E_light(p)
//          + max(0, sum_l g^l sum_m C_lm(p) Y_lm(w)) / sum_l g^l sum_m F_lm(p) Y_lm(w)]
//
// medium_light adds the first sum, single scattering with shadow maps, and medium_volumes the
// second, light of the volumes (radiance.h). The integral is a sum over points t_k; w points to the
// camera. Every second pixel along both axes has a ray. The 16 rays of a tile have different t_k
// (air_rays.h), and a mean over a tile's size joins them. pixel_planes.h defines the planes.
//
// medium_light
//   In:      view, depths [m]      the camera's surface
//            light, views, count, which, map   the light and one of its shadow maps (shade.cl)
//   In, out: scattered             in-scattered light, three planes; medium_volumes initialises it
// medium_volumes
//   In:      view, depths, medium, CLPV_RADIANCE
//   Out:     scattered
//            ends                  where a ray leaves the medium or meets a surface [m], or 0
// medium_blur
//   In:      ends, scattered;   Out: blurred, mean over five by five pixels of similar ends
// medium_add
//   In:      depths, medium, ends, blurred
//            alone   1: the scattered light; 0: T L_surface + scattered light
//   In, out: image                 RGBA; alpha stays
// A work-item processes W pixels of a row.
//
// From the host: CLPV_PLANE_STEP 2, CLPV_PLANE_LAYERS 1, CLPV_LIGHT_STEPS, CLPV_VOLUME_STEPS.
#include "gather/air_rays.h"
#include "gather/pixel_planes.h"
#include "gather/radiance.h"
#include "raster/shadow.h"
#include "raster/surface_row.h"

// Pixels whose ends differ by this share of the farther end, or more, have weight 0.
__constant const float same_end = 0.1f;
__constant const float unlike_weight = 1e-3f;  // fallback weight if no neighbour has similar depth

// Rays of the pixels of a row of planes; none in the border.
CLPV_INLINE void find_plane_rays(const ClpvView view, const PlaneRow r,
                                 __global const float* depths, const ClpvMedium medium,
                                 AirRays* a) {
  const intW column = r.x + lane_numbers(), last = (intW)((int)r.width - 1);
  const intW x = min(column, last) * CLPV_PLANE_STEP;
  const uintW pixel = as_uintW(r.y * CLPV_PLANE_STEP * (int)view.width + x);
  PixelRow p;
  p.x = to_realW(x);
  p.y = (realW)((float)(r.y * CLPV_PLANE_STEP));
  find_air_rays(view, p, (realW)CLPV_GATHER(depths, pixel), medium, a);
  a->inside &= column <= last;
  a->end = a->inside ? a->end : ZERO;
}

// Place in (0, 1) of a pixel's point in its interval: ordered dither of a 4 x 4 tile (Bayer 1973).
CLPV_INLINE realW place_in_interval(const PlaneRow r) {
  const uint y = (uint)r.y;
  const uintW x = as_uintW(r.x + lane_numbers()), across = (x ^ y) & 1u,
              beyond = ((x ^ y) >> 1) & 1u;
  const uintW place = 8u * across + 4u * (y & 1u) + 2u * beyond + ((y >> 1) & 1u);
  return (to_realW(as_intW(place)) + 0.5f) * (1.0f / 16.0f);
}

__kernel void medium_light(const ClpvView view, __global const float* depths, const ClpvLight light,
                           __global const ClpvView* views, const uint count, const uint which,
                           __global const float* map, __global float* scattered) {
  const PlaneRow r = find_plane_row(view, get_global_id(0), get_global_id(1));
  if (!row_has_pixels(r)) return;
  AirRays a;
  find_plane_rays(view, r, depths, light.medium, &a);
  const realW place = place_in_interval(r);
  const ShadowMap shadow = {views, count, which, map};
  const Vec sigma = vec_of(light.medium.scattering);
  Vec sum = vec(ZERO, ZERO, ZERO);
  for (int k = 0; k < CLPV_LIGHT_STEPS; ++k) {
    AirPoint p;
    find_air_point(&a, light.medium, place, k, CLPV_LIGHT_STEPS, &p);
    const Vec position = vec_add_scaled(a.origin, p.at, a.direction);
    Vec towards;
    realW distance;
    const Vec irradiance = clear_irradiance(light, position, &towards, &distance);
    const MediumPart part = find_medium_part(light.medium, position, towards, distance);
    const Vec share = air_share(&p, light.medium, part.end - part.start);
    const realW phase = phase_function(light.medium.anisotropy, vec_dot(towards, a.direction));
    const realW seen = phase * light_reaches(shadow, position);
    sum = vec_add_scaled(sum, seen, vec_product(share, irradiance));
  }
  const Vec before = load_plane_vectors(scattered, r.plane, r.at),
            added = vec_masked(a.inside, vec_product(sigma, sum));
  store_plane_vectors(vec_add_scaled(before, ONE, added), scattered, r.plane, r.at);
}

__kernel void medium_volumes(const ClpvView view, __global const float* depths,
                             const ClpvMedium medium, __global float* ends,
                             __global float* scattered, CLPV_RADIANCE) {
  const PlaneRow r = find_plane_row(view, get_global_id(0), get_global_id(1));
  if (!row_has_pixels(r)) return;
  AirRays a;
  find_plane_rays(view, r, depths, medium, &a);
  store_lanes(a.end, ends + r.at);
  const realW place = place_in_interval(r);
  const VecLanes w = unpack(a.inside, a.direction);
  const float g = medium.anisotropy, gg = g * g;
  Vec sum = vec(ZERO, ZERO, ZERO);
  for (int k = 0; k < CLPV_VOLUME_STEPS; ++k) {
    AirPoint p;
    find_air_point(&a, medium, place, k, CLPV_VOLUME_STEPS, &p);
    const Vec share = air_share(&p, medium, ZERO);
    const Vec none = vec(ZERO, ZERO, ZERO);
    RadianceField field;
    sample_radiance(CLPV_PASS_RADIANCE, vec_add_scaled(a.origin, p.at, a.direction), ZERO,
                    a.direction, none, none, a.inside, &field);
    float red[W], green[W], blue[W];
    for (int i = 0; i < W; ++i) {
      Coefficients y = basis_functions(-w.x[i], -w.y[i], -w.z[i]);
#pragma unroll
      for (int j = 1; j < CLPV_N; ++j) y.c[j] *= j < 4 ? g : gg;
      const float4 arriving = max(radiance_along(&field.at[i], y), 0.0f);
      red[i] = arriving.x, green[i] = arriving.y, blue[i] = arriving.z;
    }
    const Vec arriving = vec(load_lanes(red), load_lanes(green), load_lanes(blue));
    sum = vec_add_scaled(sum, ONE, vec_product(share, arriving));
  }
  store_plane_vectors(vec_masked(a.inside, vec_product(vec_of(medium.scattering), sum)), scattered,
                      r.plane, r.at);
}

// Weight of pixels whose rays end at `other`, for rays that end at `end`: 1 for equal ends; 0
// outside the medium.
CLPV_INLINE realW similarity(const realW end, const realW other) {
  const realW off = fabs(end - other), most = end > other ? end : other;
  const realW weight = 1.0f - off / (same_end * most);
  return other > ZERO ? (weight > ZERO ? weight : ZERO) : ZERO;
}

__kernel void medium_blur(const ClpvView view, __global const float* ends,
                          __global const float* scattered, __global float* blurred) {
  const PlaneRow r = find_plane_row(view, get_global_id(0), get_global_id(1));
  if (!row_has_pixels(r)) return;
  const realW end = load_lanes(ends + r.at);
  Vec sum = vec(ZERO, ZERO, ZERO);
  realW weights = ZERO;
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      const float share = (dy == -2 || dy == 2 ? 0.5f : 1.0f) * (dx == -2 || dx == 2 ? 0.5f : 1.0f);
      const uint at = (uint)((int)r.at + dy * (int)r.pitch + dx);
      const realW weight = share * similarity(end, load_lanes(ends + at));
      sum = vec_add_scaled(sum, weight, load_plane_vectors(scattered, r.plane, at));
      weights += weight;
    }
  }
  store_plane_vectors(vec_times(sum, weights > ZERO ? 1.0f / weights : ZERO), blurred, r.plane,
                      r.at);
}

// Upsamples: gives each of W camera pixels the half-resolution pixel at or left of it, or with
// `right` at or right of it. Load W of them from widen_from() on.
static inline uint widen_from(const uint px, const bool right) {
  return (px + (W == 1 && right ? 1u : 0u)) / 2;
}
CLPV_INLINE realW widen(const realW v, const bool right) {
#if W == 8
  return right ? v.s01122334 : v.s00112233;
#elif W == 1
  return v;
#endif
}

__kernel void medium_add(const ClpvView view, __global const float* depths, const ClpvMedium medium,
                         __global const float* ends, __global const float* blurred,
                         const uint alone, __global float4* image) {
  const PixelRow p = find_pixel_row(view);
  if (p.count == 0) return;
  const uint first = p.py * view.width + p.px;
  const uintW pixel = first + min(as_uintW(lane_numbers()), (uintW)(p.count - 1));
  AirRays a;
  find_air_rays(view, p, (realW)CLPV_GATHER(depths, pixel), medium, &a);
  const PlaneRow r = find_plane_row(view, (int)p.px / W, (int)p.py / CLPV_PLANE_STEP);
  Vec sum = vec(ZERO, ZERO, ZERO);
  realW weights = ZERO;
  for (uint corner = 0; corner < 4; ++corner) {
    const bool right = corner % 2 == 1;
    const uint at = r.at - p.px + widen_from(p.px, right) + (corner / 2) * (p.py % 2) * r.pitch;
    const realW end = load_lanes(ends + at), red = load_lanes(blurred + at),
                green = load_lanes(blurred + r.plane + at),
                blue = load_lanes(blurred + 2 * r.plane + at);
    const Vec light = vec(widen(red, right), widen(green, right), widen(blue, right));
    const realW weight =
        similarity(a.end, widen(end, right)) + (corner == 0 ? unlike_weight : 0.0f);
    sum = vec_add_scaled(sum, weight, light);
    weights += weight;
  }
  const VecLanes added = unpack(a.inside, vec_times(sum, 1.0f / weights));
  const VecLanes kept = unpack((intW)(-1), medium_transmittance(medium, a.end - a.start));
  for (uint i = 0; i < p.count; ++i) {
    const float4 light = (float4)(added.x[i], added.y[i], added.z[i], 0.0f),
                 before = image[first + i];
    image[first + i] = alone ? (float4)(light.x, light.y, light.z, 1.0f)
                             : before * (float4)(kept.x[i], kept.y[i], kept.z[i], 1.0f) + light;
  }
}
