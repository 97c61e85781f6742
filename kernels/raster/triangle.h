// SPDX-License-Identifier: MIT
// Intersection of a pixel's ray with a triangle of the scene: depth key and barycentric weights.
//
// One triangle, or eight in lanes (vec.h). Coordinates are relative to the eye and built from edges, so that small
// triangles far from the origin keep their precision.
#ifndef CLPV_TRIANGLE_H
#define CLPV_TRIANGLE_H

#include "shared/mesh.h"
#include "raster/surface.h"
#include "vec.h"

typedef struct {
  Vec corner;        // first vertex - eye [m]
  Vec edge1, edge2;  // second and third vertex - first
  Vec normal;        // edge1 x edge2, on the front side; not normalised
} Face;

// Face of the triangle with corners a, b, c [m].
static inline Face clpv_face(const ClpvView view, const Vec a, const Vec b, const Vec c) {
  Face face;
  face.corner = vec_minus(a, vec_of(view.eye));
  face.edge1 = vec_minus(b, a);
  face.edge2 = vec_minus(c, a);
  face.normal = vec_cross(face.edge1, face.edge2);
  return face;
}

// Steps in screen coordinates to the pixel on the right, and below.
static inline float clpv_step_x(const ClpvView view) {
  return 2.0f * view.half_width / (float)view.width;
}
static inline float clpv_step_y(const ClpvView view) {
  return -2.0f * view.half_height / (float)view.height;
}

// Vector across the view from the screen's centre to a pixel.
static inline Vec clpv_across(const ClpvView view, const Real px, const Real py) {
  const Real x = (2.0f * (px + 0.5f) / (float)view.width - 1.0f) * view.half_width;
  const Real y = (1.0f - 2.0f * (py + 0.5f) / (float)view.height) * view.half_height;
  return vec_add_scaled(vec_times(vec_of(view.right), x), y, vec_of(view.up));
}

// Vector along a pixel's ray, of depth 1 m.
static inline Vec clpv_along(const ClpvView view, const Real px, const Real py) {
  if (CLPV_PARALLEL(view)) return vec_of(view.forward);
  return vec_add_scaled(clpv_across(view, px, py), (Real)(1.0f), vec_of(view.forward));
}

// Vector from the eye to the point at `depth` [m] behind a pixel.
static inline Vec clpv_to_point(const ClpvView view, const Real px, const Real py, const Real depth) {
  if (CLPV_PARALLEL(view)) return vec_add_scaled(clpv_across(view, px, py), depth, vec_of(view.forward));
  return vec_times(clpv_along(view, px, py), depth);
}

// Key (ClpvRasterTriangle) of the face's plane at pixel (px, py), and its change per pixel along x and y. Not finite
// for a plane that is seen edge-on.
static inline Vec clpv_key_plane(const ClpvView view, const Face face, const Real px, const Real py) {
  const Real right = vec_dot(face.normal, vec_of(view.right)) * clpv_step_x(view);
  const Real down = vec_dot(face.normal, vec_of(view.up)) * clpv_step_y(view);
  if (CLPV_PARALLEL(view)) {
    const Real scale = 1.0f / vec_dot(face.normal, vec_of(view.forward));
    const Vec beside = vec_minus(face.corner, clpv_across(view, px, py));
    return vec(vec_dot(face.normal, beside) * scale, -right * scale, -down * scale);
  }
  const Real scale = -1.0f / vec_dot(face.normal, face.corner);
  return vec(vec_dot(face.normal, clpv_along(view, px, py)) * scale, right * scale, down * scale);
}

// Barycentric weights of the second and third vertex as functions of position: weight = (point - corner) . gradient.
typedef struct {
  Vec gradient1, gradient2;  // 0 for a triangle without area
} Weights;

static inline Weights clpv_weights(const Face face) {
  const Real area2 = vec_dot(face.normal, face.normal);
  const Real scale = area2 > (Real)(0.0f) ? 1.0f / area2 : (Real)(0.0f);
  Weights weights;
  weights.gradient1 = vec_times(vec_cross(face.edge2, face.normal), scale);
  weights.gradient2 = vec_times(vec_cross(face.normal, face.edge1), scale);
  return weights;
}

// Weights of all three vertices at `depth` [m] behind a pixel, clamped to the triangle: snapping to the sub-pixel grid
// can cover pixel centres just outside.
static inline Vec clpv_weights_at(const ClpvView view, const Face face, const Weights weights, const Real px,
                                  const Real py, const Real depth) {
  const Vec offset = vec_minus(clpv_to_point(view, px, py, depth), face.corner);
  const Real none = (Real)(0.0f), all = (Real)(1.0f);
  Real w1 = vec_dot(offset, weights.gradient1), w2 = vec_dot(offset, weights.gradient2);
  w1 = w1 > none ? w1 : none;
  w1 = w1 < all ? w1 : all;
  w2 = w2 > none ? w2 : none;
  w2 = w2 < all - w1 ? w2 : all - w1;
  return vec(all - w1 - w2, w1, w2);
}

#endif
