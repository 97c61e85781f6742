// SPDX-License-Identifier: MIT
// Samples accumulated volumes in packed records (pack.cl), weighted by the visibility of cells, for
// gather.cl.
//
//   w_i' = w_i v_i / sum_j w_j v_j,   w trilinear weights of the eight cells, v their visible
//                                     shares
//
// Where a way is known on which nothing stands, such as that to the eye, only those sample points
// count that see a cell which the sample point 0.85 cells along it, or at its end, sees, too: no
// point behind a wall beside the surface does. Where this point sees none, as in a wall, the next
// sample point towards the eye along each axis takes its place. If fewer than 1/64 of the weights
// remain, the cells count that it sees, or all eight without such a way. Where the white furnace is
// less than half as bright as in open space, the cells count that the next point sees.
// docs/method.md, 'Gathering'.
// A record is CLPV_PAIRS float8 per cell, each with two coefficients: (r g b f)(r g b f). The eight
// cells about a point are read as whole vectors. f is swept light of the white furnace, 0 after
// other transports.
//
// From the host: CLPV_GRID, CLPV_PAIRS; CLPV_VISIBLE 1: occluded cells do not light a surface
// (visibility.cl).
#pragma once

#include "gather/cascades.h"
#include "volume/coefficients.h"
#include "volume/seen_cells.h"

// 2 sqrt(pi): coefficient of band 0 of even light.
#define CLPV_EVEN_LIGHT 3.5449077018f

// Steps from a record to its neighbours; 0 in a grid of one cell.
enum {
  CLPV_DX = CLPV_GRID > 1 ? CLPV_PAIRS : 0,
  CLPV_DY = CLPV_GRID * CLPV_DX,
  CLPV_DZ = CLPV_GRID * CLPV_DY,
  CLPV_CELLS = CLPV_GRID * CLPV_GRID * CLPV_GRID,
};

// Coefficients of a record, or interpolated at a point.
typedef struct {
  float8 pair[CLPV_PAIRS];
} Sampled;

// Records of a cascade, and its occlusion bits (visibility.cl).
typedef struct {
  __global const float8* cells;
  __global const uchar* occluded;
  float open;  // band 0 of f in open space; 0 without f
} PackedCascade;

// Sample points of visibility along ways, of W points.
typedef struct {
  int cube[W];  // negative: not known
  // From bit 6 on a point of that cube; in bits 0, 2 and 4 the steps to it from the surface's cube,
  // each plus 1.
  int point[W];
} ClearPoints;

// For each of W points: index of the lowest of the eight cells about it, and the point's position
// between their centres, in [0, 1]; with CLPV_VISIBLE the same for the sample points of
// visibility.cl.
typedef struct {
  int number[W];
  float x[W], y[W], z[W];
  int visibility_point[W];
  float visibility_x[W], visibility_y[W], visibility_z[W];
  ClearPoints clear, next;
} SamplePoints;

// Stores the sample points at q [quarters of cells]. (x, y, z): the surfaces' cubes.
CLPV_INLINE void store_clear_points(const Vec q, const intW x, const intW y, const intW z,
                                    const intW known, ClearPoints* points) {
  const float past = 4.0f * (float)(CLPV_GRID - 1);
  const intW highest = (intW)(CLPV_GRID > 1 ? 4 * CLPV_GRID - 5 : 0);
  const intW a = min(to_intW(clamp_to(q.x, past)), highest),
             b = min(to_intW(clamp_to(q.y, past)), highest),
             c = min(to_intW(clamp_to(q.z, past)), highest);
  const intW cube = ((c >> 2) * CLPV_GRID + (b >> 2)) * CLPV_GRID + (a >> 2);
  const intW point = ((c & 3) * 4 + (b & 3)) * 4 + (a & 3);
  const intW steps = ((a >> 2) - x) + 4 * ((b >> 2) - y) + 16 * ((c >> 2) - z) + 21;
  store_lanes(known ? cube : (intW)(-1), points->cube);
  store_lanes(64 * point + steps, points->point);
}

// Finds the sample points nearest to the place 0.85 cells along `clear` from p [cells], or at its
// end, and those next to that place along each axis of `eye`. (x, y, z): p's cube.
CLPV_INLINE void find_clear_points(const Vec p, const intW x, const intW y, const intW z,
                                   const Vec clear, const Vec eye, SamplePoints* points) {
  const float most = 0.85f;  // below 1: not two cubes away
  const realW square = vec_dot(clear, clear), scale =
      square > (realW)(most * most) ? 4.0f * most * rsqrt(square) : (realW)(4.0f);
  const intW known = (clear.x != ZERO) | (clear.y != ZERO) | (clear.z != ZERO);
  const Vec q = vec_add_scaled(vec_times(p, (realW)(4.0f)), scale, clear);
  store_clear_points(q, x, y, z, known, &points->clear);
  const Vec towards = vec(sign(eye.x), sign(eye.y), sign(eye.z));
  store_clear_points(vec_add_scaled(q, (realW)(0.5f), towards), x, y, z, known, &points->next);
}

// At the last centre the eight cells are the last ones, so that offsets between them are literals.
// `clear`: ways [cells] on which nothing stands, or 0; `eye`: directions towards the eye.
CLPV_INLINE void find_sample_points(const Vec at, const Vec clear, const Vec eye,
                                    SamplePoints* points) {
  const float last = (float)(CLPV_GRID - 1);
  const intW highest = (intW)(CLPV_GRID > 1 ? CLPV_GRID - 2 : 0);
  const Vec p = vec(clamp_to(at.x, last), clamp_to(at.y, last), clamp_to(at.z, last));
  const intW x = min(to_intW(p.x), highest), y = min(to_intW(p.y), highest),
             z = min(to_intW(p.z), highest);
  const Vec t = vec(p.x - to_realW(x), p.y - to_realW(y), p.z - to_realW(z));
  const intW number = (z * CLPV_GRID + y) * CLPV_GRID + x;
  store_lanes(number, points->number);
  store_lanes(t.x, points->x), store_lanes(t.y, points->y), store_lanes(t.z, points->z);
  if (!CLPV_VISIBLE) return;
  const Vec q = vec(clamp_to(t.x * 4.0f - 0.5f, 3.0f), clamp_to(t.y * 4.0f - 0.5f, 3.0f),
                    clamp_to(t.z * 4.0f - 0.5f, 3.0f));
  const intW qx = min(to_intW(q.x), (intW)(2)), qy = min(to_intW(q.y), (intW)(2)),
             qz = min(to_intW(q.z), (intW)(2));
  store_lanes((qz * 4 + qy) * 4 + qx, points->visibility_point);
  store_lanes(q.x - to_realW(qx), points->visibility_x);
  store_lanes(q.y - to_realW(qy), points->visibility_y);
  store_lanes(q.z - to_realW(qz), points->visibility_z);
  find_clear_points(p, x, y, z, clear, eye, points);
}

// Trilinear weights of the eight corners about a point (x, y, z) in [0, 1]^3; corner bits: 1 x, 2
// y, 4 z.
CLPV_INLINE float8 corner_weights(const float x, const float y, const float z) {
  const float8 along_x =
      fma((float8)(-1, 1, -1, 1, -1, 1, -1, 1), (float8)(x), (float8)(1, 0, 1, 0, 1, 0, 1, 0));
  const float8 along_y =
      fma((float8)(-1, -1, 1, 1, -1, -1, 1, 1), (float8)(y), (float8)(1, 1, 0, 0, 1, 1, 0, 0));
  const float8 along_z =
      fma((float8)(-1, -1, -1, -1, 1, 1, 1, 1), (float8)(z), (float8)(1, 1, 1, 1, 0, 0, 0, 0));
  return along_x * along_y * along_z;
}

// Least visible share of the weights for which they count.
__constant const float min_visible = 1.0f / 64.0f;

enum { CLPV_ALL_POINTS = 511 };  // cells that none lacks: every sample point counts

// Cells, a bit each, that a point along a way sees.
static inline uint cells_seen(__global const uchar* occluded, const ClearPoints* points,
                              const int i) {
  return ~(uint)occluded[(size_t)points->cube[i] * 64 + (points->point[i] >> 6)] & 255u;
}

// Cells, a bit each, of which a sample point must see one to count.
CLPV_INLINE int clear_cells(__global const uchar* occluded, const ClearPoints* points,
                            const int i) {
  const int point = points->point[i];
  if (points->cube[i] < 0) return CLPV_ALL_POINTS;
  const uint seen = cells_seen(occluded, points, i);
  if (seen == 0) return CLPV_ALL_POINTS;
  return (int)cells_from(seen, (point & 3) - 1, (point >> 2 & 3) - 1, (point >> 4 & 3) - 1);
}

__constant const int8 cell_bits = (int8)(1, 2, 4, 8, 16, 32, 64, 128);

// Visible shares of the eight cells: their bits at those of eight sample points that see one of
// `clear`, interpolated trilinearly so that light is continuous, and constant beyond the outermost
// points.
CLPV_INLINE float8 visible_shares(__global const uchar* at, const float8 weights,
                                  const int clear) {
  float8 visible = 0.0f;
  float sum = 0.0f;
#pragma unroll
  for (int i = 0; i < 8; ++i) {
    const int seen = ~(int)at[(i & 1) + 4 * (i >> 1 & 1) + 16 * (i >> 2)];
    const float weight = (seen & clear) != 0 ? ((const float*)&weights)[i] : 0.0f;
    sum += weight;
    visible += ((int8)(seen) & cell_bits) != 0 ? (float8)(weight) : (float8)(0.0f);
  }
  return sum > 0.0f ? visible * (1.0f / sum) : visible;
}

CLPV_INLINE float sum_weights(const float8 weights) {
  const float4 four = weights.lo + weights.hi;
  return four.x + four.y + four.z + four.w;
}

// Weights of the cells that a point along a way sees, trilinear there, and their first cell;
// returns the factor that normalises them. If it sees none, or is not known, nothing changes, and
// the factor is 0.
CLPV_INLINE float use_clear_point(const PackedCascade cascade, const ClearPoints* points,
                                  const int i, float8* weights, int* number) {
  if (points->cube[i] < 0) return 0.0f;
  const int seen = (int)cells_seen(cascade.occluded, points, i), point = points->point[i] >> 6;
  if (seen == 0) return 0.0f;
  const float8 from = corner_weights(0.25f * (float)(point & 3) + 0.125f,
                                     0.25f * (float)(point >> 2 & 3) + 0.125f,
                                     0.25f * (float)(point >> 4) + 0.125f);
  *weights = ((int8)(seen) & cell_bits) != 0 ? from : (float8)(0.0f);
  *number = points->cube[i];
  return 1.0f / sum_weights(*weights);
}

// Multiplies the weights of cells by their visible shares and returns the factor that normalises
// them. If less than min_visible is visible, the point along `clear` takes the place of this one.
CLPV_INLINE float apply_visibility(const PackedCascade cascade, const SamplePoints* points,
                                   const int i, float8* weights, int* number) {
  const bool hidden =
      points->clear.cube[i] >= 0 && cells_seen(cascade.occluded, &points->clear, i) == 0;
  const ClearPoints* clear = hidden ? &points->next : &points->clear;
  __global const uchar* at =
      cascade.occluded + (size_t)points->number[i] * 64 + points->visibility_point[i];
  const float8 from =
      corner_weights(points->visibility_x[i], points->visibility_y[i], points->visibility_z[i]);
  const float8 visible =
      *weights * visible_shares(at, from, clear_cells(cascade.occluded, clear, i));
  const float total = sum_weights(visible);
  if (!(total > min_visible)) {
    const float factor = use_clear_point(cascade, clear, i, weights, number);
    return factor > 0.0f ? factor : 1.0f;
  }
  *weights = visible;
  return 1.0f / total;
}

// Least brightness of the white furnace, of that in open space, for which a place is not in a wall.
__constant const float least_open = 0.5f;

// Sum of the eight records from a cell on.
CLPV_INLINE void add_records(const PackedCascade cascade, const int number, const float8 w,
                             Sampled* r) {
  __global const float8* v = cascade.cells + (size_t)number * CLPV_PAIRS;
#pragma unroll
  for (int j = 0; j < CLPV_PAIRS; ++j)
    r->pair[j] = w.s0 * v[j] + w.s1 * v[j + CLPV_DX] + w.s2 * v[j + CLPV_DY] +
                 w.s3 * v[j + CLPV_DX + CLPV_DY] + w.s4 * v[j + CLPV_DZ] +
                 w.s5 * v[j + CLPV_DX + CLPV_DZ] + w.s6 * v[j + CLPV_DY + CLPV_DZ] +
                 w.s7 * v[j + CLPV_DX + CLPV_DY + CLPV_DZ];
}

CLPV_INLINE float sample_cells(const PackedCascade cascade, const SamplePoints* points, const int i,
                               Sampled* r) {
  int number = points->number[i];
  float8 w = corner_weights(points->x[i], points->y[i], points->z[i]);
  float scale = CLPV_VISIBLE ? apply_visibility(cascade, points, i, &w, &number) : 1.0f;
  add_records(cascade, number, w, r);
  if (CLPV_VISIBLE && scale * r->pair[0].s3 < least_open * cascade.open) {
    const float factor = use_clear_point(cascade, &points->next, i, &w, &number);
    if (factor > 0.0f) {
      scale = factor;
      add_records(cascade, number, w, r);
    }
  }
  return scale;
}

// Element by element: Oclgrind 21.10 crashes on a float8 built from two float4, because lanes are
// uninitialised while it is built.
CLPV_INLINE float8 repeat_pair(const float a, const float b) {
  return (float8)(a, a, a, a, b, b, b, b);
}

CLPV_INLINE float4 weigh(const Coefficients weights, const Sampled sampled) {
  float8 sum = 0.0f;
#pragma unroll
  for (int j = 0; j < CLPV_PAIRS; ++j) {
    const float odd = 2 * j + 1 < CLPV_N ? weights.c[2 * j + 1] : 0.0f;
    sum = fma(repeat_pair(weights.c[2 * j], odd), sampled.pair[j], sum);
  }
  return sum.lo + sum.hi;
}

// Number that light is divided by where the white furnace has f, 1 of even light. Below
// CLPV_LEAST_WHITE few of its surfaces are in sight: the number rises to 1, so that light where the
// furnace is dark stays as it is.
CLPV_INLINE float furnace_divisor(const float f) {
  return f >= CLPV_LEAST_WHITE ? f : 1.0f - (1.0f / CLPV_LEAST_WHITE - 1.0f) * fmax(f, 0.0f);
}

// Divides light by the white furnace's light, its fourth number: where even light of radiance 1
// would give `white`, this is a mean of radiances of the surfaces in sight.
CLPV_INLINE float4 over_furnace(const float4 light, const float white) {
  const float4 mean = light * (1.0f / furnace_divisor(light.w * (1.0f / white)));
  return (float4)(mean.xyz, 0.0f);
}

// Parameters: packed volumes of all cascades in one buffer, finest first, and with CLPV_VISIBLE
// their occlusion bits.
#if CLPV_VISIBLE
#define CLPV_AND_VOLUMES , __global const float8 *packed, __global const uchar *occluded
#define CLPV_PASS_VOLUMES , packed, occluded
#define CLPV_OCCLUDED_OF(c) (occluded + (size_t)(c) * CLPV_CELLS * 64)
#else
#define CLPV_AND_VOLUMES , __global const float8 *packed
#define CLPV_PASS_VOLUMES , packed
#define CLPV_OCCLUDED_OF(c) 0  // not read
#endif

// Cascade c; `area` [m^2]: s^2, 0 without f; `unit` [W/sr]: of a stored 1.
CLPV_INLINE PackedCascade packed_cascade(const uint c, const float area,
                                         const float unit CLPV_AND_VOLUMES) {
  const PackedCascade cascade = {packed + (size_t)c * CLPV_CELLS * CLPV_PAIRS,
                                 CLPV_OCCLUDED_OF(c), CLPV_EVEN_LIGHT * area / unit};
  return cascade;
}
