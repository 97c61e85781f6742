// A triangle of the scene as a view sees it: its plane, and what a pixel's ray hits on it.
//
// Everything is relative to the eye and built from edges, so that small triangles far from the origin lose no
// digits. CLPV_ORTHOGRAPHIC 1: parallel rays; 0: rays through the eye.
#ifndef CLPV_TRIANGLE_H
#define CLPV_TRIANGLE_H

#include "shared/mesh.h"
#include "surface.h"

#ifndef CLPV_ORTHOGRAPHIC
#define CLPV_ORTHOGRAPHIC 0
#endif

typedef struct {
  float3 corner;        // first vertex - eye [m]
  float3 edge1, edge2;  // second and third vertex - first
  float3 normal;        // edge1 x edge2; towards whom the triangle's front faces
} Face;

static inline Face clpv_face(const ClpvView view, __global const ClpvVertex* vertices, const uint a,
                             const uint b, const uint c) {
  const float3 p = vload3(0, vertices[a].position);
  Face face;
  face.corner = p - clpv_float3(view.eye);
  face.edge1 = vload3(0, vertices[b].position) - p;
  face.edge2 = vload3(0, vertices[c].position) - p;
  face.normal = cross(face.edge1, face.edge2);
  return face;
}

// Steps on the screen from a pixel to the next one right, and below.
static inline float clpv_step_x(const ClpvView view) {
  return 2.0f * view.half_width / (float)view.width;
}
static inline float clpv_step_y(const ClpvView view) {
  return -2.0f * view.half_height / (float)view.height;
}

static inline float3 clpv_across(const ClpvView view, const float2 s) {
  return s.x * clpv_float3(view.right) + s.y * clpv_float3(view.up);
}

// From the eye to the point at `depth` behind a pixel.
static inline float3 clpv_to_point(const ClpvView view, const float px, const float py, const float depth) {
  const float3 across = clpv_across(view, clpv_screen(view, px, py));
#if CLPV_ORTHOGRAPHIC
  return depth * clpv_float3(view.forward) + across;
#else
  return depth * (clpv_float3(view.forward) + across);
#endif
}

// The key (ClpvProjected) of the face's plane at pixel (px, py), and its change a pixel along x and y. Not
// finite where the plane is seen edge-on.
static inline float3 clpv_key_plane(const ClpvView view, const Face face, const float px, const float py) {
  const float3 across = clpv_across(view, clpv_screen(view, px, py));
  const float right = dot(face.normal, clpv_float3(view.right)) * clpv_step_x(view);
  const float down = dot(face.normal, clpv_float3(view.up)) * clpv_step_y(view);
#if CLPV_ORTHOGRAPHIC
  const float scale = 1.0f / dot(face.normal, clpv_float3(view.forward));
  return (float3)(dot(face.normal, face.corner - across) * scale, -right * scale, -down * scale);
#else
  const float scale = -1.0f / dot(face.normal, face.corner);
  return (float3)(dot(face.normal, clpv_float3(view.forward) + across) * scale, right * scale, down * scale);
#endif
}

// Weights of the second and third vertex, as functions of position: weight = dot(point - corner, gradient).
typedef struct {
  float3 gradient1, gradient2;  // 0 for a triangle without area: its first vertex stands for it
} Weights;

static inline Weights clpv_weights(const Face face) {
  const float area2 = dot(face.normal, face.normal);
  const float scale = area2 > 0.0f ? 1.0f / area2 : 0.0f;
  Weights weights;
  weights.gradient1 = cross(face.edge2, face.normal) * scale;
  weights.gradient2 = cross(face.normal, face.edge1) * scale;
  return weights;
}

// The weights of all three vertices at `depth` behind a pixel. Kept inside the triangle: snapped to the
// sub-pixel grid it may cover the centre of a pixel that it misses by a hair.
static inline float3 clpv_weights_at(const ClpvView view, const Face face, const Weights weights,
                                     const float px, const float py, const float depth) {
  const float3 offset = clpv_to_point(view, px, py, depth) - face.corner;
  const float w1 = clamp(dot(offset, weights.gradient1), 0.0f, 1.0f);
  const float w2 = clamp(dot(offset, weights.gradient2), 0.0f, 1.0f - w1);
  return (float3)(1.0f - w1 - w2, w1, w2);
}

#endif
