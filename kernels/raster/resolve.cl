// SPDX-License-Identifier: MIT
// Evaluates the surface of each pixel from the triangle that draw_tiles.cl found: depth, normal,
// albedo and emission for the camera, flux for a reflective shadow map.
//
//   P = albedo E A (n_s . w) / (n_g . w)      [W]   E the light's irradiance across the ray, A the
//                                                   texel's footprint, w towards the light
//
// n_g is the triangle's normal, n_s the interpolated one. A virtual point light lies on the
// triangle and shines about n_g, with the light that n_s weighs.
//
// docs/method.md, 'Rasterize'. Reflective shadow maps: Dachsbacher and Stamminger 2005.
//
// In:   keys, seen    depth key and triangle of each pixel (draw_tiles.cl)
//       vertices, triangles, materials, textures, texels   the scene, in rows of float4
//                                                          (shared/mesh.h)
//       views         of RSMs: of one size, in the same depths, normals and fluxes
// Out:  depths        [m] along the view's forward axis, 0 for empty pixels
//       normals       unit, towards the viewer: n_s and the number of n_g (shared/normal.h); RSMs:
//                     n_g
//       colours       albedo; emissives, with CLPV_EMISSIVE: radiance [W/m^2/sr]; fluxes: P [W]
// A work-item evaluates W pixels of a row. It selects instead of branching: empty pixels evaluate
// triangle 0, and materials without a texture have a white one. From the host: CLPV_ORTHOGRAPHIC,
// CLPV_SURFACE_PAPER, CLPV_TEXTURED (the scene has textures), CLPV_COLOURED (vertex colours other
// than 1), CLPV_EMISSIVE (emissive materials), CLPV_FROM_LIGHT (1: resolve_rsm, 0: resolve_camera).
#include "lanes.h"
#include "raster/lighting.h"
#include "raster/scene_triangles.h"
#include "raster/surface_row.h"
#include "raster/tile_row.h"
#include "raster/triangle.h"
#include "shared/view_light.h"

// Largest (n_s . w) / (n_g . w), for surfaces that the light grazes.
__constant const float largest_weight = 10.0f;

// Change of uv on a face for a step of `by` [m] across the view, from pixel to pixel.
static inline Uv uv_step(const Face face, const Weights weights, const Vec along, const Vec by,
                         const Uv uv1, const Uv uv2) {
  const Vec on_face = vec_add_scaled(by, -vec_dot(face.normal, by), along);
  const realW w1 = vec_dot(on_face, weights.gradient1), w2 = vec_dot(on_face, weights.gradient2);
  return uv_along(w1, w2, uv1, uv2);
}

// Evaluates the surface of each lane's triangle at `depth` [m] behind its pixel.
CLPV_INLINE void evaluate_surface(const ClpvView view, const PixelRow p, const realW depth,
                                  const uintW triangle, CLPV_SCENE, SurfaceLanes* surface) {
  TriangleLanes t;
  if (W > 1 && no_lane(triangle != (uintW)(first_lane(triangle)))) {
    load_triangles(CLPV_PASS_SCENE, triangle, true, &t);
  } else {
    load_triangles(CLPV_PASS_SCENE, triangle, false, &t);
  }
  const Face face = make_face(view, t.a.position, t.b.position, t.c.position);
  const Weights weights = find_weights(face);
  const Vec w = weights_at(view, face, weights, p.x, p.y, depth);
  const Vec ray = along_ray(view, p.x, p.y);
  const realW facing = vec_dot(face.normal, ray);

  const Vec front = vec_times(face.normal, facing > ZERO ? (realW)(-1.0f) : ONE);
  surface_at(&t, w, front, surface);
  if (!CLPV_TEXTURED) return;
  const Uv uv1 = uv_edge(t.a, t.b), uv2 = uv_edge(t.a, t.c);
  const realW scale = is_orthographic(view) ? ONE : depth;
  const Vec along = vec_times(ray, 1.0f / facing);
  const Vec right = vec_times(vec_of(view.right), scale * pixel_step_x(view));
  const Vec down = vec_times(vec_of(view.up), scale * pixel_step_y(view));
  const Uv step_x = uv_step(face, weights, along, right, uv1, uv2);
  const Uv step_y = uv_step(face, weights, along, down, uv1, uv2);
  apply_textures(textures, texels, &t, w, step_x, step_y, surface);
}

// Evaluates the surfaces of W pixels and stores their depths. `hit`: mask of the pixels that are
// not empty.
CLPV_INLINE void resolve(const ClpvView view, const PixelRow p, __global const realW* keys,
                         __global const uintW* seen, CLPV_SCENE, __global float* depths, intW* hit,
                         SurfaceLanes* surface) {
  const realW key = keys[p.row];
  *hit = key < (realW)(INFINITY);
  evaluate_surface(view, p, hit_depth(view, key), *hit ? seen[p.row] : (uintW)(0u), CLPV_PASS_SCENE,
                   surface);
  store_depth(view, p, key, depths);
}

#if !CLPV_FROM_LIGHT

__kernel void resolve_camera(const ClpvView view, __global const realW* keys,
                             __global const uintW* seen, __global const float4* vertices,
                             __global const float4* triangles, __global const float4* materials,
                             __global const float4* textures, __global const uint* texels,
                             __global float* depths, __global SurfaceTexel* normals,
                             __global SurfaceTexel* colours,
                             __global float4* emissives, const uint slices,
                             __global uint* counts, __global uint* slice_counts) {
  clear_counters(slices, counts, slice_counts);
  const PixelRow p = find_pixel_row(view);
  if (p.count == 0) return;
  intW hit;
  SurfaceLanes surface;
  resolve(view, p, keys, seen, CLPV_PASS_SCENE, depths, &hit, &surface);
  const uint first = p.py * view.width + p.px;
  const realW geometric = pack_geometric_normal(surface.geometric, surface.normal);
  store_normals(p, vec_masked(hit, surface.normal), hit ? geometric : ZERO, normals + first);
  store_colours(p, vec_masked(hit, surface.albedo), 1.0f, colours + first);
  if (!CLPV_EMISSIVE) return;
  const VecLanes emissive = unpack(hit, surface.emissive);
  for (uint i = 0; i < p.count; ++i)
    emissives[first + i] = (float4)(emissive.x[i], emissive.y[i], emissive.z[i], 0.0f);
}

#else

// (n_s . towards) / (n_g . towards); 1 where both normals are equal, at most largest_weight, 0 on
// the dark side.
CLPV_INLINE realW light_weight(const SurfaceLanes* surface, const Vec towards) {
  const realW shading = vec_dot(surface->normal, towards),
              geometric = vec_dot(surface->geometric, towards);
  const intW lit = (shading > ZERO) & (geometric > ZERO);
  const realW weight = lit ? shading / geometric : ZERO;
  const intW same = vec_dot(surface->geometric, surface->normal) > (realW)(CLPV_SAME_NORMAL);
  return same ? ONE : (weight < (realW)(largest_weight) ? weight : (realW)(largest_weight));
}

__kernel void resolve_rsm(__constant const ClpvLitView* views, __global const realW* keys,
                          __global const uintW* seen, __global const float4* vertices,
                          __global const float4* triangles, __global const float4* materials,
                          __global const float4* textures, __global const uint* texels,
                          __global float* depths, __global SurfaceTexel* normals,
                          __global SurfaceTexel* fluxes, const uint slices,
                          __global uint* counts, __global uint* slice_counts) {
  clear_counters(slices, counts, slice_counts);
  const ClpvLitView lit = views[get_group_id(2)];
  const ClpvView view = lit.view;
  const PixelRow p = find_pixel_row(view);
  if (p.count == 0) return;
  intW hit;
  SurfaceLanes surface;
  resolve(view, p, keys, seen, CLPV_PASS_SCENE, depths + lit.first, &hit, &surface);
  const realW depth = stored_depth(view, keys[p.row]);
  Vec towards;
  const Vec arriving = light_irradiance(lit.light, row_positions(view, p, depth), &towards);
  const Vec incident =
      vec_times(arriving, row_footprints(view, p, depth) * light_weight(&surface, towards));
  const uint first = lit.first + p.py * view.width + p.px;
  store_normals(p, vec_masked(hit, surface.geometric), ZERO, normals + first);
  store_colours(p, vec_masked(hit, vec_product(surface.albedo, incident)), lit.colour_scale,
                fluxes + first);
}

#endif
