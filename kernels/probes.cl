// SPDX-License-Identifier: MIT
// Irradiance of light probes at points (docs/bake.md, 'Formats'): trilinear interpolation of the
// numbers that the normal needs, then the format's reconstruction. The reference is
// host/bake/probe_formats.cpp.
//
// From the host: CLPV_PROBE, one of the names below; CLPV_STORED, numbers of a probe per channel;
// CLPV_READ, those that a look-up reads; CLPV_BASIS and its tables (basis/basis.h).
#include "basis/basis.h"

#define CLPV_PROBE_BASIS 0  // sum of c_i alpha_i(n)
#define CLPV_PROBE_CUBE 1
#define CLPV_PROBE_DICE 2
#define CLPV_PROBE_LOBES 3
#define CLPV_PROBE_GEOMERICS 4
#define CLPV_PROBE_ZONAL 5  // zh3
#define CLPV_PROBE_GUESSED 6  // zh3-hallucinated

#define CLPV_PHI 1.61803398875f

// Which numbers a look-up reads, and their factors.
typedef struct {
  int number[CLPV_READ];
  float factor[CLPV_READ];
} Reads;

#if CLPV_PROBE == CLPV_PROBE_CUBE
CLPV_INLINE Reads reads_of(const float n[3]) {
  Reads r;
#pragma unroll
  for (int axis = 0; axis < 3; ++axis) {
    r.number[axis] = 2 * axis + (n[axis] < 0.0f);
    r.factor[axis] = M_PI_F * n[axis] * n[axis];
  }
  return r;
}
#elif CLPV_PROBE == CLPV_PROBE_DICE
// Vertex of axis k: phi towards k, 1 towards k + 1, with the signs of n. These three are a face; a
// normal beyond one of its edges lies in the neighbour, whose third vertex has the other sign of 1.
CLPV_INLINE Reads reads_of(const float n[3]) {
  const float x = fabs(n[0]), y = fabs(n[1]), z = fabs(n[2]);
  // Multiples of the shares (s_0, s_1, s_2) with s_0 (phi, 1, 0) + s_1 (0, phi, 1) + ... = |n|.
  const float p = CLPV_PHI, q = CLPV_PHI * CLPV_PHI;
  float share[3] = {fma(q, x, y) - p * z, fma(q, y, z) - p * x, fma(q, z, x) - p * y};
  Reads r;
  float sum = 0.0f;
#pragma unroll
  for (int k = 0; k < 3; ++k)
    r.number[k] = 4 * k + 2 * (n[k] < 0.0f) + (n[(k + 1) % 3] < 0.0f);
#pragma unroll
  for (int k = 0; k < 3; ++k) {
    if (share[k] >= 0.0f) continue;
    r.number[k] = r.number[(k + 2) % 3] ^ 1;
    share[(k + 1) % 3] += share[k] / CLPV_PHI, share[(k + 2) % 3] += share[k] / CLPV_PHI;
    share[k] = -share[k];
    break;
  }
#pragma unroll
  for (int k = 0; k < 3; ++k) sum += share[k];
#pragma unroll
  for (int k = 0; k < 3; ++k) r.factor[k] = M_PI_F * share[k] / sum;
  return r;
}
#elif CLPV_PROBE == CLPV_PROBE_LOBES
CLPV_INLINE Reads reads_of(const float n[3]) {
  const float whole = rsqrt(1.0f + CLPV_PHI * CLPV_PHI);
  Reads r;
#pragma unroll
  for (int k = 0; k < 12; ++k) {
    const float a = k & 2 ? -CLPV_PHI : CLPV_PHI, b = k & 1 ? -1.0f : 1.0f;
    const float t = fmax(0.0f, whole * fma(a, n[k / 4], b * n[(k / 4 + 1) % 3]));
    r.number[k] = k, r.factor[k] = M_PI_F * t * t * fma(0.25f * t, t, 0.35f);
  }
  return r;
}
#else
CLPV_INLINE Reads reads_of(const float n[3]) {
  const Coefficients alpha = cosine_integrals(n[0], n[1], n[2]);
  Reads r;
#pragma unroll
  for (int k = 0; k < CLPV_READ; ++k)
    r.number[k] = k, r.factor[k] = k < CLPV_N ? alpha.c[min(k, CLPV_N - 1)] : 0.0f;
  return r;
}
#endif

#if CLPV_PROBE == CLPV_PROBE_GEOMERICS
CLPV_INLINE float3 irradiance_of(const Reads r, const float3 c[CLPV_READ], const float n[3]) {
  const float3 mean = 0.28209479f * c[0];
  const float3 x = 0.16286751f * c[3], y = 0.16286751f * c[1], z = 0.16286751f * c[2];
  const float3 length = sqrt(x * x + y * y + z * z), least = (float3)(FLT_MIN);
  const float3 ratio = fmin(length / fmax(mean, least), (float3)(1.0f)), p = 1.0f + 2.0f * ratio;
  const float3 a = (1.0f - ratio) / (1.0f + ratio);
  const float3 cosine = (x * n[0] + y * n[1] + z * n[2]) / fmax(length, least);
  const float3 q = clamp(0.5f + 0.5f * cosine, (float3)(0.0f), (float3)(1.0f));
  return M_PI_F * fmax(mean, (float3)(0.0f)) * (a + (1.0f - a) * (p + 1.0f) * pow(q, p));
}
#else
CLPV_INLINE float3 irradiance_of(const Reads r, const float3 c[CLPV_READ], const float n[3]) {
  float3 e = (float3)(0.0f);
#pragma unroll
  for (int k = 0; k < CLPV_READ; ++k) e += r.factor[k] * c[k];
#if CLPV_PROBE == CLPV_PROBE_ZONAL || CLPV_PROBE == CLPV_PROBE_GUESSED
  const float3 luminance = (float3)(0.2126f, 0.7152f, 0.0722f);
  const float3 flow = (float3)(dot(luminance, c[3]), dot(luminance, c[1]), dot(luminance, c[2]));
  const float3 axis = flow / fmax(length(flow), FLT_MIN);
#if CLPV_PROBE == CLPV_PROBE_ZONAL
  const float3 zonal = c[CLPV_READ - 1];
#else
  const float3 mean = fmax(c[0], (float3)(0.0f));
  const float3 ratio = fabs(c[3] * axis.x + c[1] * axis.y + c[2] * axis.z) /
                       fmax(mean, (float3)(FLT_MIN));
  const float3 zonal = mean * ratio * (0.08f + 0.6f * ratio);
#endif
  const float t = axis.x * n[0] + axis.y * n[1] + axis.z * n[2];
  e += 0.25f * M_PI_F * 0.63078313f * (1.5f * t * t - 0.5f) * zonal;
#endif
  return e;
}
#endif

// `side`: probes along each axis. `points`: position in spacings from the first probe, at least 0
// and below side - 1; normal.
__kernel void look_up_probes(const int count, const int side, __global const float* probes,
                             __global const float* points, __global float* light) {
  const int item = get_global_id(0);
  if (item >= count) return;
  const float n[3] = {points[6 * item + 3], points[6 * item + 4], points[6 * item + 5]};
  float part[3];
  int low[3];
#pragma unroll
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = (int)points[6 * item + axis];
    part[axis] = points[6 * item + axis] - (float)low[axis];
  }
  const Reads r = reads_of(n);
  float3 c[CLPV_READ];
#pragma unroll
  for (int k = 0; k < CLPV_READ; ++k) c[k] = (float3)(0.0f);
#pragma unroll
  for (int corner = 0; corner < 8; ++corner) {
    const int x = corner & 1, y = corner >> 1 & 1, z = corner >> 2;
    const float weight = (x ? part[0] : 1.0f - part[0]) * (y ? part[1] : 1.0f - part[1]) *
                         (z ? part[2] : 1.0f - part[2]);
    const int probe = ((low[2] + z) * side + low[1] + y) * side + low[0] + x;
#pragma unroll
    for (int k = 0; k < CLPV_READ; ++k)
      c[k] += weight * vload3(probe * CLPV_STORED + r.number[k], probes);
  }
  vstore3(irradiance_of(r, c, n), item, light);
}
