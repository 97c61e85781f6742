// SPDX-License-Identifier: MIT
// Averages the near field along surfaces and adds it to the irradiance (near.cl).
//
// near_blur
//   A window of five by five pixels, with half weight at its edges, weights (1/2 1 1 1 1/2) along
//   both axes, so that each of a tile's 4 x 4 sets of rays counts equally. Pixels count if they are
//   on the same surface (near_surface.h).
//   In:      points        near_layout.h; light: D and E of near.cl
//   Out:     blurred       their means
// near_widen
//   Averages three by three blurred pixels, every third along both axes, which makes the window one
//   of eleven by eleven. Pixels count by the same rules if they are also nearer than 0.2 R, so that
//   the window stays small where pixels are far apart.
//   In:      points, blurred
//   Out:     widened       their means
// near_add
//   Interpolates D and E bilinearly between pixels of both layers on the same surface. If there is
//   none, takes the mean of those in the 4 x 4 blocks around that are on the same surface; failing
//   that, of all in these blocks.
//   In:      places, normals       the camera's surface (surface_row.h): depths [m], or with
//                                  CLPV_POINTS positions [m]
//            points, widened
//   In, out: irradiance    E [W/m^2] per pixel of the camera:
//     E = E_gathered + mean D                             mean D >= 0, per channel
//     E = E_gathered f(1 + mean D / mean E_gathered)      elsewhere (darkened)
//     f(x) = x, or below 1/4: 1 / (16 (1/2 - x))
// A work-item processes W pixels of a row.
#include "gather/near_surface.h"
#include "raster/surface_row.h"

__constant const float widened_reach = 0.2f;  // [R]
__constant const float dark_share = 0.25f;  // share of light below which darkening slows down

// Sums of D, E and weights.
typedef struct {
  Vec difference, gathered;
  realW weight;
} WeightedSum;

CLPV_INLINE void add_weighted(const Vec difference, const Vec gathered, const realW weight,
                              WeightedSum* sum) {
  sum->difference = vec_add_scaled(sum->difference, weight, difference);
  sum->gathered = vec_add_scaled(sum->gathered, weight, gathered);
  sum->weight += weight;
}

CLPV_INLINE void store_means(const WeightedSum sum, const PlaneRow r, __global float* light) {
  const realW scale = sum.weight > ZERO ? 1.0f / sum.weight : ZERO;
  store_plane_vectors(vec_times(sum.difference, scale), light + CLPV_NEAR_DIFFERENCE * r.plane,
                      r.plane, r.at);
  store_plane_vectors(vec_times(sum.gathered, scale), light + CLPV_NEAR_GATHERED * r.plane, r.plane,
                      r.at);
}

static inline WeightedSum no_sum(void) {
  const WeightedSum none = {{ZERO, ZERO, ZERO}, {ZERO, ZERO, ZERO}, ZERO};
  return none;
}

__kernel void near_blur(const ClpvView view, __global const float* points,
                        __global const float* light, __global float* blurred) {
  const PlaneRow r = find_plane_row(view, get_global_id(0), get_global_id(1));
  if (!row_has_pixels(r)) return;
  NearSurfaces here;
  load_near_surfaces(points, r.plane, r.at, &here);
  WeightedSum sum = no_sum();
  for (int dy = -2; dy <= 2 && lane_bits(here.reach > ZERO) != 0u; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      const float share = (dy == -2 || dy == 2 ? 0.5f : 1.0f) * (dx == -2 || dx == 2 ? 0.5f : 1.0f);
      const uint at = (uint)((int)r.at + dy * (int)r.pitch + dx);
      NearSurfaces n;
      load_near_surfaces(points, r.plane, at, &n);
      add_weighted(load_plane_vectors(light + CLPV_NEAR_DIFFERENCE * r.plane, r.plane, at),
                   load_plane_vectors(light + CLPV_NEAR_GATHERED * r.plane, r.plane, at),
                   same_surface(n, here.position, here.normal) ? (realW)(share) : ZERO, &sum);
    }
  }
  store_means(sum, r, blurred);
}

__kernel void near_widen(const ClpvView view, __global const float* points,
                         __global const float* blurred, __global float* widened) {
  const PlaneRow r = find_plane_row(view, get_global_id(0), get_global_id(1));
  if (!row_has_pixels(r)) return;
  NearSurfaces here;
  load_near_surfaces(points, r.plane, r.at, &here);
  const realW far = widened_reach * here.reach;
  WeightedSum sum = no_sum();
  for (int dy = -3; dy <= 3 && lane_bits(far > ZERO) != 0u; dy += 3) {
    for (int dx = -3; dx <= 3; dx += 3) {
      const uint at = (uint)((int)r.at + dy * (int)r.pitch + dx);
      NearSurfaces n;
      load_near_surfaces(points, r.plane, at, &n);
      const Vec apart = vec_minus(n.position, here.position);
      const intW near =
          (vec_dot(apart, apart) < far * far) & same_surface(n, here.position, here.normal);
      add_weighted(load_plane_vectors(blurred + CLPV_NEAR_DIFFERENCE * r.plane, r.plane, at),
                   load_plane_vectors(blurred + CLPV_NEAR_GATHERED * r.plane, r.plane, at),
                   near ? ONE : ZERO, &sum);
    }
  }
  store_means(sum, r, widened);
}

// f(left) of the header: share of E that is kept where D < 0; left = (mean E + mean D) / mean E. It
// is positive even where nine harmonics make `left` negative.
CLPV_INLINE realW darkened(const realW left) {
  return left > dark_share ? left : dark_share * dark_share / (2.0f * dark_share - left);
}

// Factor of E in a channel where D < 0, else 1.
CLPV_INLINE realW darkening_factor(const realW difference, const realW gathered) {
  const intW darker = (difference < ZERO) & (gathered > ZERO);
  return darker ? darkened((gathered + difference) / gathered) : ONE;
}

CLPV_INLINE realW clamp_positive(const realW v) {
  return v > ZERO ? v : ZERO;
}

#if CLPV_PLANE_LAYERS > 1
// Upsamples near pixels from `first` on to W camera pixels; adds those on the camera pixel's
// surface, with `any` on any surface.
CLPV_INLINE void add_spread(__global const float* points, __global const float* widened,
                            const uint plane, const uint first, const bool right, const Surfaces s,
                            const bool any, const realW weight, WeightedSum* sum) {
  const uint at = spread_from(first, right);
  if (lane_bits(load_lanes(points + CLPV_NEAR_REACH * plane + at) > ZERO) == 0u) return;
  NearSurfaces n;
  load_near_surfaces(points, plane, at, &n);
  spread_surfaces(&n, right);
  add_weighted(
      spread_vectors(load_plane_vectors(widened + CLPV_NEAR_DIFFERENCE * plane, plane, at), right),
      spread_vectors(load_plane_vectors(widened + CLPV_NEAR_GATHERED * plane, plane, at), right),
      (any ? n.reach > ZERO : same_surface(n, s.position, s.normal)) ? weight : ZERO, sum);
}

// Means at W pixels of the camera.
CLPV_INLINE void interpolate_light(const ClpvView view, const PixelRow p, const Surfaces s,
                                   const PlaneRow r, __global const float* points,
                                   __global const float* widened, WeightedSum* sum) {
  const uint first = r.at - p.px + p.px / CLPV_PLANE_STEP,
             second = second_layer_row(view) * r.pitch;
  const realW across =
      to_realW(((int)p.px + lane_numbers()) % CLPV_PLANE_STEP) * (1.0f / CLPV_PLANE_STEP);
  const float down = (float)(p.py % CLPV_PLANE_STEP) * (1.0f / CLPV_PLANE_STEP);
  for (uint layer = 0; layer < 2; ++layer) {
    for (uint corner = 0; corner < 4; ++corner) {
      const bool right = corner % 2 == 1, below = corner / 2 == 1;
      const realW weight = (right ? across : ONE - across) * (below ? down : 1.0f - down);
      add_spread(points, widened, r.plane, first + layer * second + (below ? r.pitch : 0u), right,
                 s, false, weight, sum);
    }
  }
  for (uint any = 0; any < 2; ++any) {
    const intW lone = (s.depth > ZERO) & (sum->weight == ZERO);
    if (lane_bits(lone) == 0u) return;
    for (uint layer = 0; layer < 2; ++layer) {
      for (int dy = -1; dy <= 2; ++dy) {
        for (int dx = -1; dx <= 2; ++dx) {
          const uint at = (uint)((int)(first + layer * second) + dy * (int)r.pitch + dx);
          add_spread(points, widened, r.plane, at, false, s, any == 1, lone ? ONE : ZERO, sum);
        }
      }
    }
  }
}
#endif

__kernel void near_add(const ClpvView view, __global const Place* places,
                       __global const float4* normals, __global const float* points,
                       __global const float* widened, __global float4* irradiance) {
  const PixelRow p = find_pixel_row(view);
  if (p.count == 0) return;
  Surfaces s;
  CLPV_LOAD_SURFACES(view, p, places, normals, &s);
  const PlaneRow r = find_plane_row(view, (int)p.px / W, (int)p.py / CLPV_PLANE_STEP);
  WeightedSum mean = no_sum();
#if CLPV_PLANE_STEP == 1
  add_weighted(load_plane_vectors(widened + CLPV_NEAR_DIFFERENCE * r.plane, r.plane, r.at),
               load_plane_vectors(widened + CLPV_NEAR_GATHERED * r.plane, r.plane, r.at), ONE,
               &mean);
#else
  interpolate_light(view, p, s, r, points, widened, &mean);
#endif
  const intW lit = (s.depth > ZERO) & (mean.weight > ZERO);
  const realW scale = lit ? 1.0f / mean.weight : ZERO;
  const Vec d = vec_times(mean.difference, scale), e = vec_times(mean.gathered, scale);
  const VecLanes added = unpack(lit,
                                vec(clamp_positive(d.x), clamp_positive(d.y), clamp_positive(d.z))),
                 factor =
                     unpack((intW)(-1), vec(darkening_factor(d.x, e.x), darkening_factor(d.y, e.y),
                                            darkening_factor(d.z, e.z)));
  for (uint i = 0; i < p.count; ++i) {
    irradiance[s.first + i] =
        irradiance[s.first + i] * (float4)(factor.x[i], factor.y[i], factor.z[i], 1.0f) +
        (float4)(added.x[i], added.y[i], added.z[i], 0.0f);
  }
}
