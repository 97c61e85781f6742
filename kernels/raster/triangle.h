// SPDX-License-Identifier: MIT
// Intersection of a pixel's ray with a triangle of the scene: depth key and barycentric weights.
//
// W triangles, or one W times (vec.h). Coordinates are relative to the eye and built from edges, so
// that small triangles far from the origin keep their precision.
#pragma once

#include "shared/mesh.h"
#include "raster/surface.h"
#include "vec.h"

typedef struct {
  Vec corner;        // first vertex - eye [m]
  Vec edge1, edge2;  // second and third vertex - first
  Vec normal;        // edge1 x edge2, on the front side; not normalised
} Face;

// Face of the triangle with corners a, b, c [m].
static inline Face make_face(const ClpvView view, const Vec a, const Vec b, const Vec c) {
  Face face;
  face.corner = vec_minus(a, vec_of(view.eye));
  face.edge1 = vec_minus(b, a);
  face.edge2 = vec_minus(c, a);
  face.normal = vec_cross(face.edge1, face.edge2);
  return face;
}

// Steps in screen coordinates to the pixel on the right, and below.
static inline float pixel_step_x(const ClpvView view) {
  return 2.0f * view.half_width / (float)view.width;
}
static inline float pixel_step_y(const ClpvView view) {
  return -2.0f * view.half_height / (float)view.height;
}

// Vector across the view from the screen's centre to a pixel.
static inline Vec across_view(const ClpvView view, const realW px, const realW py) {
  const realW x = (2.0f * (px + 0.5f) / (float)view.width - 1.0f) * view.half_width;
  const realW y = (1.0f - 2.0f * (py + 0.5f) / (float)view.height) * view.half_height;
  return vec_add_scaled(vec_times(vec_of(view.right), x), y, vec_of(view.up));
}

// Vector along a pixel's ray, of depth 1 m.
static inline Vec along_ray(const ClpvView view, const realW px, const realW py) {
  if (is_orthographic(view)) return vec_of(view.forward);
  return vec_add_scaled(across_view(view, px, py), ONE, vec_of(view.forward));
}

// Vector from the eye to the point at `depth` [m] behind a pixel.
static inline Vec to_point(const ClpvView view, const realW px, const realW py, const realW depth) {
  if (is_orthographic(view))
    return vec_add_scaled(across_view(view, px, py), depth, vec_of(view.forward));
  return vec_times(along_ray(view, px, py), depth);
}

// Key (ClpvRasterTriangle) of the face's plane at pixel (px, py), and its change per pixel along x
// and y. Not finite for a plane that is seen edge-on.
static inline Vec find_key_plane(const ClpvView view, const Face face, const realW px,
                                 const realW py) {
  const realW right = vec_dot(face.normal, vec_of(view.right)) * pixel_step_x(view);
  const realW down = vec_dot(face.normal, vec_of(view.up)) * pixel_step_y(view);
  if (is_orthographic(view)) {
    const realW scale = 1.0f / vec_dot(face.normal, vec_of(view.forward));
    const Vec beside = vec_minus(face.corner, across_view(view, px, py));
    return vec(vec_dot(face.normal, beside) * scale, -right * scale, -down * scale);
  }
  const realW scale = -1.0f / vec_dot(face.normal, face.corner);
  return vec(vec_dot(face.normal, along_ray(view, px, py)) * scale, right * scale, down * scale);
}

// Barycentric weights of the second and third vertex as functions of position: weight = (point -
// corner) . gradient.
typedef struct {
  Vec gradient1, gradient2;  // 0 for a triangle without area
} Weights;

static inline Weights find_weights(const Face face) {
  const realW area2 = vec_dot(face.normal, face.normal);
  const realW scale = area2 > ZERO ? 1.0f / area2 : ZERO;
  Weights weights;
  weights.gradient1 = vec_times(vec_cross(face.edge2, face.normal), scale);
  weights.gradient2 = vec_times(vec_cross(face.normal, face.edge1), scale);
  return weights;
}

// Weights of all three vertices at `depth` [m] behind a pixel, clamped to the triangle: snapping to
// the sub-pixel grid can cover pixel centres just outside.
static inline Vec weights_at(const ClpvView view, const Face face, const Weights weights,
                             const realW px, const realW py, const realW depth) {
  const Vec offset = vec_minus(to_point(view, px, py, depth), face.corner);
  realW w1 = vec_dot(offset, weights.gradient1), w2 = vec_dot(offset, weights.gradient2);
  w1 = w1 > ZERO ? w1 : ZERO;
  w1 = w1 < ONE ? w1 : ONE;
  w2 = w2 > ZERO ? w2 : ZERO;
  w2 = w2 < ONE - w1 ? w2 : ONE - w1;
  return vec(ONE - w1 - w2, w1, w2);
}
