// SPDX-License-Identifier: MIT
// Averages the near field along surfaces and adds it to the irradiance (near.cl).
//
// near_blur
//   A window of five by five pixels, with half weight at its edges, counts each pixel of a tile once: (1/2 1 1 1 1/2)
//   along both axes. Pixels count if their normal is within 45 degrees and their distance from the plane of the surface
//   below 0.1 R.
//   In:      points        near_layout.h; differences: D of near.cl
//   Out:     blurred       D, three planes
// near_widen
//   Averages three by three blurred pixels, every third along both axes, which makes the window one of eleven by eleven.
//   Pixels count by the same rules if they are also nearer than 0.2 R, so that the window stays small where pixels are
//   far apart.
//   In:      points, blurred
//   Out:     widened       D, three planes
// near_add
//   Interpolates D bilinearly between pixels of the near field on the same surface; 0 if none is.
//   In:      depths [m], normals   the camera's surface; points, widened
//   In, out: irradiance    E [W/m^2] per pixel of the camera: max(0, E + D)
// A work-item processes eight pixels of a row.
#include "gather/near_layout.h"
#include "raster/surface_row.h"

#define CLPV_SAME_NORMAL 0.7f  // cosine
#define CLPV_SAME_PLANE 0.1f   // [R]
#define CLPV_WIDENED 0.2f      // [R]

// Surfaces of eight neighbours.
typedef struct {
  Vec position, normal, difference;
  realW reach;
} Neighbours;

CLPV_INLINE void load_neighbours(__global const float* points, __global const float* differences, const uint plane,
                                 const uint at, Neighbours* n) {
  n->position = load_near_vectors(points + CLPV_NEAR_POSITION * plane, plane, at);
  n->normal = load_near_vectors(points + CLPV_NEAR_NORMAL * plane, plane, at);
  n->reach = load_lanes(points + CLPV_NEAR_REACH * plane + at);
  n->difference = load_near_vectors(differences, plane, at);
}

// Weight of neighbours: 1 on the same surface, else 0.
CLPV_INLINE realW same_surface(const Neighbours n, const Vec position, const Vec normal) {
  const realW off = fabs(vec_dot(vec_minus(n.position, position), normal));
  const intW same = (vec_dot(normal, n.normal) > (realW)(CLPV_SAME_NORMAL)) & (off < CLPV_SAME_PLANE * n.reach);
  return same ? ONE : ZERO;
}

// Sums of differences and weights.
typedef struct {
  Vec difference;
  realW weight;
} WeightedSum;

CLPV_INLINE void add_weighted(const Neighbours n, const realW weight, WeightedSum* sum) {
  sum->difference = vec_add_scaled(sum->difference, weight, n.difference);
  sum->weight += weight;
}

CLPV_INLINE Vec mean_of(const WeightedSum sum) {
  return vec_times(sum.difference, sum.weight > ZERO ? 1.0f / sum.weight : ZERO);
}

__kernel void near_blur(const ClpvView view, __global const float* points, __global const float* differences,
                        __global float* blurred) {
  const NearRow r = find_near_row(view, get_global_id(0), get_global_id(1));
  if (!row_has_pixels(r)) return;
  const Vec position = load_near_vectors(points + CLPV_NEAR_POSITION * r.plane, r.plane, r.at);
  const Vec normal = load_near_vectors(points + CLPV_NEAR_NORMAL * r.plane, r.plane, r.at);
  WeightedSum sum = {{ZERO, ZERO, ZERO}, ZERO};
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      const float share = (dy == -2 || dy == 2 ? 0.5f : 1.0f) * (dx == -2 || dx == 2 ? 0.5f : 1.0f);
      Neighbours n;
      load_neighbours(points, differences, r.plane, (uint)((int)r.at + dy * (int)r.pitch + dx), &n);
      add_weighted(n, share * same_surface(n, position, normal), &sum);
    }
  }
  store_near_vectors(mean_of(sum), blurred, r.plane, r.at);
}

__kernel void near_widen(const ClpvView view, __global const float* points, __global const float* blurred,
                         __global float* widened) {
  const NearRow r = find_near_row(view, get_global_id(0), get_global_id(1));
  if (!row_has_pixels(r)) return;
  const Vec position = load_near_vectors(points + CLPV_NEAR_POSITION * r.plane, r.plane, r.at);
  const Vec normal = load_near_vectors(points + CLPV_NEAR_NORMAL * r.plane, r.plane, r.at);
  const realW reach = CLPV_WIDENED * load_lanes(points + CLPV_NEAR_REACH * r.plane + r.at);
  WeightedSum sum = {{ZERO, ZERO, ZERO}, ZERO};
  for (int dy = -3; dy <= 3; dy += 3) {
    for (int dx = -3; dx <= 3; dx += 3) {
      Neighbours n;
      load_neighbours(points, blurred, r.plane, (uint)((int)r.at + dy * (int)r.pitch + dx), &n);
      const Vec apart = vec_minus(n.position, position);
      add_weighted(n, vec_dot(apart, apart) < reach * reach ? same_surface(n, position, normal) : ZERO, &sum);
    }
  }
  store_near_vectors(mean_of(sum), widened, r.plane, r.at);
}

#if CLPV_NEAR_STEP == 2
// Neighbours of eight pixels of the camera: on even columns the pixel itself, on odd ones that on the left or right.
#define CLPV_WIDEN(v) (right ? (v).s01122334 : (v).s00112233)
CLPV_INLINE void widen(Neighbours* n, const bool right) {
  n->position = vec(CLPV_WIDEN(n->position.x), CLPV_WIDEN(n->position.y), CLPV_WIDEN(n->position.z));
  n->normal = vec(CLPV_WIDEN(n->normal.x), CLPV_WIDEN(n->normal.y), CLPV_WIDEN(n->normal.z));
  n->difference = vec(CLPV_WIDEN(n->difference.x), CLPV_WIDEN(n->difference.y), CLPV_WIDEN(n->difference.z));
  n->reach = CLPV_WIDEN(n->reach);
}
#endif

__kernel void near_add(const ClpvView view, __global const float* depths, __global const float4* normals,
                       __global const float* points, __global const float* widened, __global float4* irradiance) {
  const PixelRow p = find_pixel_row(view);
  if (p.count == 0) return;
  Surfaces s;
  load_surfaces(view, p, depths, normals, &s);
  const NearRow r = find_near_row(view, (int)p.px / W, (int)p.py / CLPV_NEAR_STEP);
#if CLPV_NEAR_STEP == 1
  const Vec difference = load_near_vectors(widened, r.plane, r.at);
#else
  WeightedSum sum = {{ZERO, ZERO, ZERO}, ZERO};
  const uint first = r.at - p.px / 2;
  for (uint corner = 0; corner < 4; ++corner) {
    Neighbours n;
    load_neighbours(points, widened, r.plane, first + (corner / 2) * (p.py % 2) * r.pitch, &n);
    widen(&n, corner % 2 == 1);
    add_weighted(n, same_surface(n, s.position, s.normal), &sum);
  }
  const Vec difference = mean_of(sum);
#endif
  const VecLanes added = unpack(s.depth > ZERO, difference);
  for (uint i = 0; i < p.count; ++i) {
    const float4 e = irradiance[s.first + i];
    irradiance[s.first + i] = max(e + (float4)(added.x[i], added.y[i], added.z[i], 0.0f), 0.0f);
  }
}
