// SPDX-License-Identifier: MIT
// Emitters, the parts of emissive triangles that virtual point lights stand on, shared by host and
// kernels (host/scene/emission.hpp).
#pragma once

// A triangle similar to its scene triangle: points with weights (u, v) + size (s, t) of the second
// and third corner, s, t >= 0 and s + t <= 1. It is cut into rows^2 congruent sub-triangles, with a
// virtual point light at the centroid of each.
typedef struct {
  unsigned int triangle;
  float u, v;
  float size;          // negative: inverted
  unsigned int rows;   // 1 or more
  unsigned int first;  // number of the first point
  float side;          // 1: the front emits; -1: the back emits
  unsigned int unused;
} ClpvEmitter;

// Mean of a texture over a sub-triangle: CLPV_EMIT_SAMPLES^2 samples, at the mip level for
// CLPV_EMIT_FOOTPRINT times their distance, so that all texels have about the same weight.
enum { CLPV_EMIT_SAMPLES = 8 };
#define CLPV_EMIT_FOOTPRINT 2.0f
