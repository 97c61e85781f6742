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

// Weights of four texels at these distances from the filter's middle.
static inline float4 clpv_tap_weights(const float4 distance) { return clamp(2.0f - fabs(distance), 0.0f, 1.0f); }

// Where in a shadow map a receiver lies, and its lifted tangent plane: the plane is at depth d behind the texel at
// (dx, dy) from there where d (a + per_depth g) = b - (1 - per_depth) g,  g = dx slope.x + dy slope.y.
typedef struct {
  float2 texel;  // pixel coordinates
  float2 slope;
  float a, b;
  float per_depth;  // 1: perspective, 0: orthographic
  float depth;      // of the plane at `texel` itself
} Receiver;

// `offset`: from the light's eye to the surface [m]; `cosine` of the light's angle to the normal, above 0.
static inline Receiver clpv_receiver(const ClpvView view, const float3 offset, const float3 normal,
                                     const float cosine) {
  const float3 right = clpv_float3(view.right), up = clpv_float3(view.up), forward = clpv_float3(view.forward);
  const float depth = dot(offset, forward);
  const float scale = view.orthographic != 0.0f ? 1.0f : depth;
  const float2 s = (float2)(dot(offset, right), dot(offset, up)) / scale;
  const float2 size = (float2)((float)view.width, (float)view.height);
  const float2 edge = (float2)(2.0f * view.half_width, -2.0f * view.half_height) / size;  // of a texel at depth 1
  const float lift = scale * edge.x *
                     (CLPV_SHADOW_LIFT_FLAT + CLPV_SHADOW_LIFT_SLOPED * sqrt(fmax(1.0f - cosine * cosine, 0.0f)));
  const float across = s.x * dot(normal, right) + s.y * dot(normal, up);
  Receiver r;
  r.per_depth = view.orthographic != 0.0f ? 0.0f : 1.0f;
  r.texel = (s / (float2)(view.half_width, -view.half_height) + 1.0f) * 0.5f * size - 0.5f;
  r.slope = edge * (float2)(dot(normal, right), dot(normal, up));
  r.a = dot(normal, forward) + r.per_depth * across;
  r.b = dot(normal, offset) + lift - (1.0f - r.per_depth) * across;
  r.depth = r.b / r.a;
  return r;
}

// How much of the light arrives, 0..1; 1 outside the map.
static inline float clpv_visibility(const ClpvView view, __global const float* map, const Receiver r) {
  const int2 last = (int2)((int)view.width, (int)view.height) - CLPV_SHADOW_TAPS;
  const float2 at = clamp(r.texel, -(float)CLPV_SHADOW_TAPS, convert_float2(last) + 2 * CLPV_SHADOW_TAPS);
  const int2 first = clamp(convert_int2(floor(at)) - 1, 0, last);
  const float4 dx = (float4)(0.0f, 1.0f, 2.0f, 3.0f) + ((float)first.x - at.x);
  const float4 dy = (float4)(0.0f, 1.0f, 2.0f, 3.0f) + ((float)first.y - at.y);
  const float4 wx = clpv_tap_weights(dx), wy = clpv_tap_weights(dy);
  __global const float* row = map + first.y * (int)view.width + first.x;
  float4 blocked = 0.0f;
#define CLPV_ROW(j)                                                                    \
  {                                                                                    \
    const float4 d = vload4(0, row + (j) * (int)view.width);                           \
    const float4 g = dx * r.slope.x + dy.s##j * r.slope.y;                             \
    const int4 before = d * (r.a + r.per_depth * g) > r.b - (1.0f - r.per_depth) * g; \
    blocked += select((float4)(0.0f), wx * wy.s##j, (d > 0.0f) & before & (d < r.depth)); \
  }
  CLPV_ROW(0)
  CLPV_ROW(1)
  CLPV_ROW(2)
  CLPV_ROW(3)
#undef CLPV_ROW
  const float4 one = 1.0f;
  const float whole = dot(wx, one) * dot(wy, one);
  return whole > 0.0f ? 1.0f - dot(blocked, one) / whole : 1.0f;
}

// Of several views from one eye, the one that looks most along `offset`; of equals the first.
static inline bool clpv_sees(__global const ClpvView* views, const uint count, const uint which, const float3 offset) {
  const ClpvView mine = views[which];
  const float along = dot(offset, clpv_float3(mine.forward));
  for (uint v = 0; v < count; ++v) {
    const ClpvView other = views[v];
    const float rival = dot(offset, clpv_float3(other.forward));
    if (rival > along || (rival == along && v < which)) return false;
  }
  return true;
}

// Adds to `direct` what `light` puts on the surfaces that its view `which` of `count` sees. Without views (count 0)
// it casts no shadows.
__kernel void light_surfaces(const ClpvView camera, __global const float* depths, __global const SurfaceTexel* normals,
                             const ClpvLight light, __global const ClpvView* views, const uint count, const uint which,
                             __global const float* map, __global float4* direct) {
  const uint px = get_global_id(0), py = get_global_id(1);
  if (px >= camera.width || py >= camera.height) return;
  const uint pixel = py * camera.width + px;
  const float depth = depths[pixel];
  if (depth <= 0.0f) return;
  const float3 position = clpv_position(camera, (float)px, (float)py, depth);
  const float3 normal = clpv_load_normal(normals, pixel);
  float3 towards;
  float3 irradiance = clpv_light_irradiance(light, position, &towards);
  const float cosine = dot(normal, towards);
  if (cosine <= 0.0f) return;
  irradiance *= cosine;
  if (count > 0) {
    const ClpvView view = views[which];
    const float3 offset = position - clpv_float3(view.eye);
    if (count > 1 && !clpv_sees(views, count, which, offset)) return;
    irradiance *= clpv_visibility(view, map, clpv_receiver(view, offset, normal, cosine));
  }
  direct[pixel] += (float4)(irradiance.x, irradiance.y, irradiance.z, 0.0f);
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
