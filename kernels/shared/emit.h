// SPDX-License-Identifier: MIT
// Parts of emissive triangles that points are put on, as host and kernels both see them (host/scene/emission.hpp).
#ifndef CLPV_SHARED_EMIT_H
#define CLPV_SHARED_EMIT_H

// A triangle's weights of its second and third corner, at a part's own points: (u, v) + size (s, t), s and t from 0 on, up to
// a sum of 1. It is cut into rows^2 pieces alike, each a point with a light.
typedef struct {
  unsigned int triangle;
  float u, v;
  float size;          // negative: the other way round
  unsigned int rows;   // 1 or more
  unsigned int first;  // number of its first point
  float side;          // 1: it lights what its front faces, -1: what its back does
  unsigned int unused;
} ClpvEmitter;

#define CLPV_SIZEOF_EMITTER 32

// A texture's mean over a piece is taken from CLPV_EMIT_LOOKS^2 looks at it, each in the middle of a piece of the piece, at
// the level of texels that are CLPV_EMIT_FOOTPRINT times as wide: each texel then counts as often as any other.
#define CLPV_EMIT_LOOKS 8
#define CLPV_EMIT_FOOTPRINT 2.0f

#endif
