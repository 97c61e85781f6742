// SPDX-License-Identifier: MIT
// Shade: what the lights put on every surface the camera sees, behind their shadow maps; and the image of it.
//
//   radiance = albedo/pi (E_direct + E_indirect) + emission
//
// A shadow map is read with a 4 x 4 filter: a box of three texels, slid over them continuously, hence the weight
// clamp(2 - |distance|, 0, 1) a texel and axis. Each texel's depth is held against the depth of the receiver's own
// tangent plane behind that very texel. A map samples surfaces at its texels' centres, so a flat receiver meets itself
// exactly, at any slope; lifting it along the normal (shared/shade.h) covers rounding, smooth normals on flat triangles,
// and corners. What stands closer to the receiver than the lift casts no shadow on it.
#include "lighting.h"
#include "shared/shade.h"
#include "surface.h"
#include "surface_row.h"

// Where in a shadow map eight receivers lie, and their lifted tangent planes: a plane is at depth d behind the texel at
// (dx, dy) from there where d (a + per_depth g) = b - (1 - per_depth) g,  g = dx slope_x + dy slope_y.
typedef struct {
  float8 x, y;  // pixel coordinates
  float8 slope_x, slope_y;
  float8 a, b;
  float8 depth;     // of the plane at (x, y) itself
  float per_depth;  // 1: perspective, 0: orthographic
} Receivers;

// `offset`: from the light's eye to the surfaces [m]; `cosine` of the light's angle to the normal, above 0.
CLPV_INLINE void receivers(const ClpvView view, const Vec offset, const Vec normal, const float8 cosine,
                           Receivers* r) {
  const Vec right = vec_of(view.right), up = vec_of(view.up), forward = vec_of(view.forward);
  const float8 scale = view.orthographic != 0.0f ? (float8)(1.0f) : vec_dot_unfused(offset, forward);
  const float8 sx = vec_dot_unfused(offset, right) / scale, sy = vec_dot_unfused(offset, up) / scale;
  const float width = (float)view.width, height = (float)view.height;
  const float edge_x = 2.0f * view.half_width / width, edge_y = -2.0f * view.half_height / height;  // at depth 1
  const float8 none = (float8)(0.0f), square = 1.0f - cosine * cosine;
  const float8 sine = sqrt(square > none ? square : none);
  const float8 lift = scale * edge_x * (CLPV_SHADOW_LIFT_FLAT + CLPV_SHADOW_LIFT_SLOPED * sine);
  const float8 along_x = vec_dot_unfused(normal, right), along_y = vec_dot_unfused(normal, up);
  const float8 across = sx * along_x + sy * along_y;
  r->per_depth = view.orthographic != 0.0f ? 0.0f : 1.0f;
  r->x = (sx / view.half_width + 1.0f) * 0.5f * width - 0.5f;
  r->y = (sy / -view.half_height + 1.0f) * 0.5f * height - 0.5f;
  r->slope_x = edge_x * along_x;
  r->slope_y = edge_y * along_y;
  r->a = vec_dot_unfused(normal, forward) + r->per_depth * across;
  r->b = vec_dot_unfused(normal, offset) + lift - (1.0f - r->per_depth) * across;
  r->depth = r->b / r->a;
}

// The first texel that the filter of each of eight receivers reads along an axis, and how far it lies from its middle.
typedef struct {
  int8 first;
  float8 distance;
} Taps;

static inline Taps taps(const float8 texel, const int size) {
  const float8 least = (float8)(-(float)CLPV_SHADOW_TAPS), most = (float8)((float)(size + CLPV_SHADOW_TAPS));
  const float8 at = texel > least ? (texel < most ? texel : most) : least;
  const int8 whole = convert_int8(at), below = whole + (convert_float8(whole) > at);
  Taps t;
  t.first = min(max(below - 1, (int8)(0)), (int8)(size - CLPV_SHADOW_TAPS));
  t.distance = convert_float8(t.first) - at;
  return t;
}

// Weights of texels at these distances from the filter's middle.
static inline float4 tap_weights(const float4 distance) {
  return clamp(2.0f - fabs(distance), (float4)(0.0f), (float4)(1.0f));
}

// One receiver of eight, and the four texels along each axis that its filter reads.
typedef struct {
  float4 dx, dy;  // from the filter's middle
  float slope_x, slope_y, a, b, depth, per_depth;
} Receiver;

// (Element by element: Oclgrind crashes on what (float8)(a, b) becomes.)
static inline float8 side_by_side(const float4 a, const float4 b) {
  return (float8)(a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w);
}
static inline float8 two_rows(const float2 a) { return (float8)(a.x, a.x, a.x, a.x, a.y, a.y, a.y, a.y); }

// The weights of those texels of two rows of the filter, `d` their depths, that block.
CLPV_INLINE float8 blocking_rows(const Receiver r, const float8 d, const float2 dy, const float8 wx, const float2 wy) {
  const float8 weights = wx * two_rows(wy);
  const float8 g = side_by_side(r.dx, r.dx) * r.slope_x + two_rows(dy) * r.slope_y;
  const int8 before = d * (r.a + r.per_depth * g) > r.b - (1.0f - r.per_depth) * g;
  return select((float8)(0.0f), weights, (d > 0.0f) & before & (d < r.depth));
}

// The weight of those texels of a receiver's filter that block, and of all: 0 outside the map. `row`: the filter's first.
CLPV_INLINE float blocking(const Receiver r, __global const float* row, const uint width, float* whole) {
  const float4 wx = tap_weights(r.dx), wy = tap_weights(r.dy), one = 1.0f;
  const float8 upper = side_by_side(vload4(0, row), vload4(0, row + width));
  const float8 lower = side_by_side(vload4(0, row + 2 * width), vload4(0, row + 3 * width));
  const float8 above = blocking_rows(r, upper, r.dy.lo, side_by_side(wx, wx), wy.lo);
  const float8 below = blocking_rows(r, lower, r.dy.hi, side_by_side(wx, wx), wy.hi);
  const float4 blocked = above.lo + above.hi + below.lo + below.hi;
  *whole = dot(wx, one) * dot(wy, one);
  return dot(blocked, one);
}

// How much of the light arrives at eight receivers, 0..1; 1 outside the map. Only of those that are `lit` at all.
CLPV_INLINE float8 visibilities(const ClpvView view, __global const float* map, const Receivers r, const int8 lit) {
  const Taps tx = taps(r.x, (int)view.width), ty = taps(r.y, (int)view.height);
  int wanted[CLPV_ABREAST], first[CLPV_ABREAST];
  float distance_x[CLPV_ABREAST], distance_y[CLPV_ABREAST], slope_x[CLPV_ABREAST], slope_y[CLPV_ABREAST];
  float a[CLPV_ABREAST], b[CLPV_ABREAST], depth[CLPV_ABREAST], blocked[CLPV_ABREAST], whole[CLPV_ABREAST];
  vstore8(lit, 0, wanted);
  vstore8(ty.first * (int)view.width + tx.first, 0, first);
  vstore8(tx.distance, 0, distance_x), vstore8(ty.distance, 0, distance_y);
  vstore8(r.slope_x, 0, slope_x), vstore8(r.slope_y, 0, slope_y);
  vstore8(r.a, 0, a), vstore8(r.b, 0, b), vstore8(r.depth, 0, depth);
  const float4 step = (float4)(0.0f, 1.0f, 2.0f, 3.0f);
  for (int i = 0; i < CLPV_ABREAST; ++i) {
    blocked[i] = whole[i] = 0.0f;
    if (!wanted[i]) continue;
    const Receiver receiver = {step + distance_x[i], step + distance_y[i], slope_x[i], slope_y[i], a[i], b[i], depth[i],
                               r.per_depth};
    blocked[i] = blocking(receiver, map + first[i], view.width, whole + i);
  }
  const float8 all = vload8(0, whole), one = (float8)(1.0f);
  return all > (float8)(0.0f) ? one - vload8(0, blocked) / all : one;
}

// Of several views from one eye, whether the one that looks most along `offset` is `which`; of equals the first.
CLPV_INLINE int8 sees(__global const ClpvView* views, const uint count, const uint which, const Vec offset) {
  const ClpvView mine = views[which];
  const float8 along = vec_dot_unfused(offset, vec_of(mine.forward));
  int8 seen = (int8)(-1);
  for (uint v = 0; v < count; ++v) {
    const ClpvView other = views[v];
    const float8 rival = vec_dot_unfused(offset, vec_of(other.forward));
    seen &= ~((rival > along) | ((rival == along) & (v < which ? -1 : 0)));
  }
  return seen;
}

// What `light` puts on the surfaces that its view `which` of `count` sees: into `direct` if `fresh`, else added to it.
// Without views (count 0) it casts no shadows. A work-item lights eight pixels of a row.
__kernel void light_surfaces(const ClpvView camera, __global const float* depths, __global const float4* normals,
                             const ClpvLight light, __global const ClpvView* views, const uint count, const uint which,
                             __global const float* map, const uint fresh, __global float4* direct) {
  const Eight p = this_row(camera);
  if (p.count == 0) return;
  Surfaces seen;
  surfaces(camera, p, depths, normals, &seen);
  const Vec normal = seen.normal, position = seen.position;
  const float8 none = (float8)(0.0f);
  Vec towards;
  Vec irradiance = clpv_light_irradiance(light, position, &towards);
  const float8 cosine = vec_dot_unfused(normal, towards);
  int8 lit = (seen.depth > none) & (cosine > none);
  irradiance = vec_times(irradiance, cosine);
  if (count > 0) {
    const ClpvView view = views[which];
    const Vec offset = vec_minus(position, vec_of(view.eye));
    if (count > 1) lit &= sees(views, count, which, offset);
    Receivers r;
    receivers(view, offset, normal, cosine, &r);
    irradiance = vec_times(irradiance, visibilities(view, map, r, lit));
  }
  const Unpacked lanes = unpack(lit, irradiance);
  for (uint i = 0; i < p.count; ++i) {
    const float4 added = (float4)(lanes.x[i], lanes.y[i], lanes.z[i], 0.0f);
    direct[seen.first + i] = fresh ? added : direct[seen.first + i] + added;
  }
}

// The image of one CLPV_SHOW_*. `emissive` may be null.
__kernel void shade(const uint show, const uint pixels, __global const float* depths,
                    __global const SurfaceTexel* normals, __global const SurfaceTexel* albedos,
                    __global const float4* emissive, __global const float4* direct, __global const float4* indirect,
                    __global float4* image) {
  const uint pixel = get_global_id(0);
  if (pixel >= pixels) return;
  const float depth = depths[pixel];
  if (depth <= 0.0f) {
    image[pixel] = (float4)(0.0f);
    return;
  }
  const float3 albedo = clpv_load_colour(albedos, pixel, 1.0f);
  float3 shown = 0.0f;
  if (show == CLPV_SHOW_FULL || show == CLPV_SHOW_DIRECT) {
    shown += albedo * M_1_PI_F * direct[pixel].xyz;
    if (emissive) shown += emissive[pixel].xyz;
  }
  if (show == CLPV_SHOW_FULL || show == CLPV_SHOW_INDIRECT) shown += albedo * M_1_PI_F * indirect[pixel].xyz;
  if (show == CLPV_SHOW_IRRADIANCE) shown = indirect[pixel].xyz;
  if (show == CLPV_SHOW_ALBEDO) shown = albedo;
  if (show == CLPV_SHOW_NORMAL) shown = clpv_load_normal(normals, pixel);
  if (show == CLPV_SHOW_DEPTH) shown = depth;
  image[pixel] = (float4)(shown.x, shown.y, shown.z, 1.0f);
}
