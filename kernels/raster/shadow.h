// SPDX-License-Identifier: MIT
// Irradiance of a light with shadow maps on W surfaces, and whether it reaches points in the air.
//
// The shadow filter has 4 x 4 taps: a box of three texels at any sub-texel position, hence the
// weight clamp(2 - |distance|, 0, 1) per texel and axis. Each texel's depth is compared with the
// depth of the plane of the receiver's triangle at that texel. A flat receiver of any slope then
// does not shadow itself. A lift along the triangle's normal (shared/shade.h) covers rounding and
// corners; occluders closer than the lift cast no shadow.
//
// The lift lets light in under a roof, along the edge where the roof meets the receiver's wall. So
// receivers that some texel does not occlude are tested:
// (1) From each of the four inner texels above the plane and its higher outer neighbours,
//     extrapolate the height to the filter's centre.
// (2) No positive result: the receiver is below no surface (a concave corner gives negative ones)
//     and keeps its lift.
// (3) Else it has no lift, and two kinds of texels do not count: texels below its plane, and texels
//     on the edge, where the next two texels towards the centre extrapolate to the plane.
// (4) If the height is within rounding and lit texels lie in the plane, it is a concave corner
//     after all: keep the lift.
// Tested only where shading and triangle normal agree: triangles of a curved mesh lie above each
// other's planes.
#pragma once

#include "lanes.h"
#include "raster/lighting.h"
#include "shared/normal.h"
#include "shared/shade.h"
#include "shared/view.h"
#include "vec.h"

// W receivers in a shadow map, with their tangent planes. A texel of depth d, at (dx, dy) from the
// receiver, is d (a + per_depth g) + (1 - per_depth) g - b [m] above the plane, g = dx slope_x + dy
// slope_y.
typedef struct {
  realW x, y;  // pixel coordinates
  realW slope_x, slope_y;
  realW a, b;
  realW lift, rounding;  // [m]
  float per_depth;       // 1: perspective, 0: orthographic
} Receivers;

// Sets up receivers. `offset`: from the light's eye to the surfaces [m]; `normal`: the triangle's;
// `cosine`: of the angle between `normal` and the direction to the light.
CLPV_INLINE void find_receivers(const ClpvView view, const Vec offset, const Vec normal,
                                const realW cosine, Receivers* r) {
  const Vec right = vec_of(view.right), up = vec_of(view.up), forward = vec_of(view.forward);
  const realW scale = view.orthographic != 0.0f ? ONE : vec_dot_unfused(offset, forward);
  const realW sx = vec_dot_unfused(offset, right) / scale, sy = vec_dot_unfused(offset, up) / scale;
  const float width = (float)view.width, height = (float)view.height;
  // at depth 1
  const float edge_x = 2.0f * view.half_width / width, edge_y = -2.0f * view.half_height / height;
  const realW square = 1.0f - cosine * cosine;
  const realW sine = sqrt(square > ZERO ? square : ZERO);
  const realW edge = scale * edge_x;
  const realW along_x = vec_dot_unfused(normal, right), along_y = vec_dot_unfused(normal, up);
  const realW across = sx * along_x + sy * along_y;
  r->per_depth = view.orthographic != 0.0f ? 0.0f : 1.0f;
  r->x = (sx / view.half_width + 1.0f) * 0.5f * width - 0.5f;
  r->y = (sy / -view.half_height + 1.0f) * 0.5f * height - 0.5f;
  r->slope_x = edge_x * along_x;
  r->slope_y = edge_y * along_y;
  r->a = vec_dot_unfused(normal, forward) + r->per_depth * across;
  r->b = vec_dot_unfused(normal, offset) - (1.0f - r->per_depth) * across;
  r->lift = edge * fmin(CLPV_SHADOW_LIFT_FLAT + CLPV_SHADOW_LIFT_SLOPED * sine,
                        CLPV_SHADOW_LIFT_DEPTH * cosine);
  r->rounding = edge * CLPV_SHADOW_ROUNDING_TEXELS +
                fabs(vec_dot_unfused(offset, forward)) * CLPV_SHADOW_ROUNDING_DEPTH;
}

// First texel of the filter of each of W receivers along an axis, and its distance [texels] from
// the filter's centre.
typedef struct {
  intW first;
  realW distance;
} Taps;

static inline Taps find_taps(const realW texel, const int size) {
  const realW lowest = (realW)(-(float)CLPV_SHADOW_TAPS),
              highest = (realW)((float)(size + CLPV_SHADOW_TAPS));
  const realW at = texel > lowest ? (texel < highest ? texel : highest) : lowest;
  const intW whole = to_intW(at), below = to_realW(whole) > at ? whole - 1 : whole;
  Taps t;
  t.first = min(max(below - 1, (intW)(0)), (intW)(size - CLPV_SHADOW_TAPS));
  t.distance = to_realW(t.first) - at;
  return t;
}

// Filter weights of texels at these distances [texels] from the centre.
static inline float4 tap_weights(const float4 distance) {
  return clamp(2.0f - fabs(distance), (float4)(0.0f), (float4)(1.0f));
}

// One receiver, and the distances of its filter texels.
typedef struct {
  float4 dx, dy;  // [texels] from the filter's centre
  float slope_x, slope_y, a, b, lift, rounding, per_depth;
} Receiver;

// Element by element: Oclgrind crashes on (float8)(a, b).
static inline float8 side_by_side(const float4 a, const float4 b) {
  return (float8)(a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w);
}
static inline float8 two_rows(const float2 a) {
  return (float8)(a.x, a.x, a.x, a.x, a.y, a.y, a.y, a.y);
}

// Heights of the texels of two rows above a receiver's plane [m]; those without a surface are far
// below. `d`: their depths [m].
CLPV_INLINE float8 texel_heights(const Receiver r, const float8 d, const float2 dy) {
  const float8 g = side_by_side(r.dx, r.dx) * r.slope_x + two_rows(dy) * r.slope_y;
  const float8 height = d * (r.a + r.per_depth * g) + ((1.0f - r.per_depth) * g - r.b);
  return select((float8)(-1e6f * r.lift), height, d > 0.0f);
}

// Height [m] of the map's surface above a receiver; 0 or less: none is above it. `upper`,
// `lower`: heights of the filter's first and last two rows.
CLPV_INLINE float surface_above(const Receiver r, const float8 upper, const float8 lower) {
  const float4 inner = (float4)(upper.s5, upper.s6, lower.s1, lower.s2);
  const int4 above = inner > r.rounding;
  if ((above.x | above.y | above.z | above.w) == 0) return 0.0f;
  const float4 beside = (float4)(upper.s4, upper.s7, lower.s0, lower.s3),
               past = (float4)(upper.s1, upper.s2, lower.s5, lower.s6);
  const float4 x = fabs((float4)(r.dx.y, r.dx.z, r.dx.y, r.dx.z)),
               y = fabs((float4)(r.dy.y, r.dy.y, r.dy.z, r.dy.z));
  const float4 centre = inner - max(beside - inner, 0.0f) * x - max(past - inner, 0.0f) * y;
  const float4 height = select((float4)(0.0f), centre, above);
  return max(max(height.x, height.y), max(height.z, height.w));
}

// Mask of the texels of two rows that count for a receiver below a surface: those neither below its
// plane nor on the edge where the surface meets it. `h`: their heights; `inner`: heights of the two
// inner rows; `others`: of the other two rows.
CLPV_INLINE int8 counted_texels(const Receiver r, const float8 h, const float8 inner,
                                const float8 others) {
  const float8 beside = h.s12125656, past = h.s23016745;  // towards the filter's centre
  const float8 along_x = fabs(2.0f * beside - past), along_y = fabs(2.0f * inner - others);
  const int8 meets = ((beside > r.rounding) & (along_x < 2.0f * r.rounding)) |
                     ((inner > r.rounding) & (along_y < 2.0f * r.rounding));
  return (h > r.rounding) | ((h > -r.rounding) & ~meets);
}

// Filter weights of the texels of two rows.
CLPV_INLINE float8 row_weights(const float4 wx, const float2 wy) {
  return side_by_side(wx, wx) * two_rows(wy);
}

// Weight of a receiver's occluding texels; `whole`: weight of all that count, 0 outside the map.
// `row`: first row of the filter.
CLPV_INLINE float blocked_weight(const Receiver r, __global const float* row, const uint width,
                                 float* whole) {
  const float4 wx = tap_weights(r.dx), wy = tap_weights(r.dy), one = 1.0f;
  const float8 upper_w = row_weights(wx, wy.lo), lower_w = row_weights(wx, wy.hi), none = 0.0f;
  const float8 upper_d = side_by_side(vload4(0, row), vload4(0, row + width));
  const float8 lower_d = side_by_side(vload4(0, row + 2 * width), vload4(0, row + 3 * width));
  const float8 upper = texel_heights(r, upper_d, r.dy.lo),
               lower = texel_heights(r, lower_d, r.dy.hi);
  const float depth = (r.b + r.lift) / r.a;  // depth of the lifted receiver
  const float8 blocked = select(none, upper_w, (upper > r.lift) & (upper_d < depth)) +
                         select(none, lower_w, (lower > r.lift) & (lower_d < depth));
  const float sum = dot(blocked.lo + blocked.hi, one);
  *whole = dot(wx, one) * dot(wy, one);
  if (sum >= CLPV_SHADOW_WHOLE * *whole) return *whole;
  const float surface = surface_above(r, upper, lower);
  if (surface <= 0.0f) return sum;
  const float8 inner = side_by_side(upper.hi, lower.lo);
  const float8 counted = select(none, upper_w, counted_texels(r, upper, inner, lower)) +
                         select(none, lower_w, counted_texels(r, lower, inner, upper));
  const float8 above = select(none, upper_w, upper > r.rounding) +
                       select(none, lower_w, lower > r.rounding);
  const float8 lit = counted - above;
  if (surface <= r.rounding && dot(lit.lo + lit.hi, one) > 0.0f) return sum;
  *whole = dot(counted.lo + counted.hi, one);
  return dot(above.lo + above.hi, one);
}

// Visible share of the light at W receivers, 0 to 1; 1 outside the map and the mask `lit`.
CLPV_INLINE realW find_visibility(const ClpvView view, __global const float* map, const Receivers r,
                                  const intW lit) {
  const Taps tx = find_taps(r.x, (int)view.width), ty = find_taps(r.y, (int)view.height);
  int wanted[W], first[W];
  float distance_x[W], distance_y[W], slope_x[W], slope_y[W];
  float a[W], b[W], lift[W], rounding[W], blocked[W], whole[W];
  store_lanes(lit, wanted);
  store_lanes(ty.first * (int)view.width + tx.first, first);
  store_lanes(tx.distance, distance_x), store_lanes(ty.distance, distance_y);
  store_lanes(r.slope_x, slope_x), store_lanes(r.slope_y, slope_y);
  store_lanes(r.a, a), store_lanes(r.b, b);
  store_lanes(r.lift, lift), store_lanes(r.rounding, rounding);
  const float4 step = (float4)(0.0f, 1.0f, 2.0f, 3.0f);
  for (int i = 0; i < W; ++i) {
    blocked[i] = whole[i] = 0.0f;
    if (!wanted[i]) continue;
    const Receiver receiver = {
        step + distance_x[i], step + distance_y[i], slope_x[i], slope_y[i], a[i], b[i], lift[i],
        rounding[i], r.per_depth};
    blocked[i] = blocked_weight(receiver, map + first[i], view.width, whole + i);
  }
  const realW all = load_lanes(whole);
  return all > ZERO ? ONE - load_lanes(blocked) / all : ONE;
}

// Mask of the points that view `which` covers: of views with one eye, the one that faces `offset`
// most directly; on a tie, the first.
CLPV_INLINE intW view_covers(__global const ClpvView* views, const uint count, const uint which,
                             const Vec offset) {
  const ClpvView mine = views[which];
  const realW along = vec_dot_unfused(offset, vec_of(mine.forward));
  intW seen = (intW)(-1);
  for (uint v = 0; v < count; ++v) {
    const ClpvView other = views[v];
    const realW rival = vec_dot_unfused(offset, vec_of(other.forward));
    seen &= ((rival > along) | ((rival == along) & (v < which ? -1 : 0))) == 0;
  }
  return seen;
}

// A light and one of its shadow maps.
typedef struct {
  __global const ClpvView* views;
  uint count;  // number of views; 0: no shadows
  uint which;  // the view of `map`
  __global const float* map;  // depths [m]
} ShadowMap;

// Irradiance [W/m^2] of a light on the surfaces that its view covers. `normal` weighs light,
// `geometric` decides which side it comes from (shared/normal.h). `lit`: mask of the surfaces to
// light; on return, those that face the light and lie in this view. The result is undefined
// elsewhere.
CLPV_INLINE Vec shadowed_irradiance(const ClpvLight light, const ShadowMap shadow,
                                    const Vec position, const Vec normal, const Vec geometric,
                                    intW* lit) {
  Vec towards;
  Vec irradiance = light_irradiance(light, position, &towards);
  const realW cosine = vec_dot_unfused(normal, towards),
              facing = vec_dot_unfused(geometric, towards);
  *lit &= (cosine > ZERO) & (facing > ZERO);
  irradiance = vec_times(irradiance, cosine);
  if (shadow.count == 0) return irradiance;
  const intW flat = vec_dot(geometric, normal) > (realW)(CLPV_SAME_NORMAL);
  *lit &= flat | (facing > (realW)(CLPV_SHADOW_GRAZING));
  const ClpvView view = shadow.views[shadow.which];
  const Vec offset = vec_minus(position, vec_of(view.eye));
  if (shadow.count > 1) *lit &= view_covers(shadow.views, shadow.count, shadow.which, offset);
  Receivers r;
  find_receivers(view, offset, geometric, facing, &r);
  r.rounding +=
      CLPV_SHADOW_ROUNDING_PLACE * (fabs(position.x) + fabs(position.y) + fabs(position.z));
  r.rounding = flat ? r.rounding : (realW)(INFINITY);  // below no surface
  return vec_times(irradiance, find_visibility(view, shadow.map, r, *lit));
}

// 1 where the light reaches points in the air by the nearest texel of this map, else 0.
CLPV_INLINE realW light_reaches(const ShadowMap shadow, const Vec position) {
  if (shadow.count == 0) return ONE;
  const ClpvView view = shadow.views[shadow.which];
  const Vec offset = vec_minus(position, vec_of(view.eye));
  const realW depth = vec_dot_unfused(offset, vec_of(view.forward));
  const realW scale = view.orthographic != 0.0f ? ONE : depth;
  const float width = (float)view.width, height = (float)view.height;
  const realW x = (vec_dot_unfused(offset, vec_of(view.right)) / (scale * view.half_width) + 1.0f) *
                  (0.5f * width);
  const realW y = (1.0f - vec_dot_unfused(offset, vec_of(view.up)) / (scale * view.half_height)) *
                  (0.5f * height);
  const intW in_map =
      (x >= ZERO) & (y >= ZERO) & (x < (realW)(width)) & (y < (realW)(height)) & (depth > ZERO);
  const uintW texel = in_map ? to_uintW(y) * view.width + to_uintW(x) : (uintW)(0u);
  const realW nearest = (realW)CLPV_GATHER(shadow.map, texel);
  const intW blocked = in_map & (nearest > ZERO) & (nearest < depth);
  const realW lit = blocked ? ZERO : ONE;
  return shadow.count > 1
             ? (view_covers(shadow.views, shadow.count, shadow.which, offset) ? lit : ZERO)
             : lit;
}
