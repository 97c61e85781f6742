// SPDX-License-Identifier: MIT
// Vectors of three components, W at a time (lanes.h). Functions here do not return vec(...): with
// rusticl 25.0 a function that returns another one's struct loses components
// (results/rusticl-25.0.7-llvmpipe/faults.c).
#pragma once

#include "lanes.h"

typedef struct {
  realW x, y, z;
} Vec;

static inline Vec vec(const realW x, const realW y, const realW z) { return (Vec){x, y, z}; }

static inline Vec vec_of(const float v[3]) {
  return (Vec){(realW)(v[0]), (realW)(v[1]), (realW)(v[2])};
}
static inline Vec vec_load(__global const float* v) {
  return (Vec){(realW)(v[0]), (realW)(v[1]), (realW)(v[2])};
}
static inline Vec vec_minus(const Vec a, const Vec b) {
  return (Vec){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline Vec vec_times(const Vec a, const realW s) {
  return (Vec){a.x * s, a.y * s, a.z * s};
}
static inline Vec vec_product(const Vec a, const Vec b) {
  return (Vec){a.x * b.x, a.y * b.y, a.z * b.z};
}
static inline realW vec_dot(const Vec a, const Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// Dot product without fused multiply-adds, for the same result on every device.
static inline realW vec_dot_unfused(const Vec a, const Vec b) {
#pragma OPENCL FP_CONTRACT OFF
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// a + s b
static inline Vec vec_add_scaled(const Vec a, const realW s, const Vec b) {
  return (Vec){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline Vec vec_cross(const Vec a, const Vec b) {
  return (Vec){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// a in lanes inside the mask, b elsewhere.
static inline Vec vec_selected(const intW mask, const Vec a, const Vec b) {
  return (Vec){mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

// Attribute at barycentric weights w of corners a, b and c: a + w.y (b - a) + w.z (c - a), so that
// a constant attribute stays that constant.
static inline realW interpolated(const Vec w, const realW a, const realW b, const realW c) {
  return a + w.y * (b - a) + w.z * (c - a);
}
static inline Vec vec_interpolated(const Vec w, const Vec a, const Vec b, const Vec c) {
  return (Vec){a.x + w.y * (b.x - a.x) + w.z * (c.x - a.x),
               a.y + w.y * (b.y - a.y) + w.z * (c.y - a.y),
               a.z + w.y * (b.z - a.z) + w.z * (c.z - a.z)};
}

// w.x a + w.y b + w.z c
static inline Vec vec_blend(const Vec w, const Vec a, const Vec b, const Vec c) {
  return (Vec){w.x * a.x + w.y * b.x + w.z * c.x, w.x * a.y + w.y * b.y + w.z * c.y,
             w.x * a.z + w.y * b.z + w.z * c.z};
}
