// Vectors of named scalars. Cheaper on PoCL than float3, whose fourth component is computed too.
#ifndef CLPV_VEC_H
#define CLPV_VEC_H

typedef struct {
  float x, y, z;
} Vec;

// Texture coordinates.
typedef struct {
  float u, v;
} Uv;

static inline Vec vec(const float x, const float y, const float z) {
  const Vec v = {x, y, z};
  return v;
}

static inline Vec vec_of(const float v[3]) {
  return vec(v[0], v[1], v[2]);
}
static inline Vec vec_load(__global const float* v) {
  return vec(v[0], v[1], v[2]);
}
static inline Vec vec_minus(const Vec a, const Vec b) {
  return vec(a.x - b.x, a.y - b.y, a.z - b.z);
}
static inline Vec vec_times(const Vec a, const float s) {
  return vec(a.x * s, a.y * s, a.z * s);
}
static inline float vec_dot(const Vec a, const Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

// a + s b
static inline Vec vec_add_scaled(const Vec a, const float s, const Vec b) {
  return vec(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}

static inline Vec vec_cross(const Vec a, const Vec b) {
  return vec(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

static inline Vec vec_product(const Vec a, const Vec b) {
  return vec(a.x * b.x, a.y * b.y, a.z * b.z);
}
static inline Vec vec_if(const bool holds, const Vec v) {
  return vec(holds ? v.x : 0.0f, holds ? v.y : 0.0f, holds ? v.z : 0.0f);
}

// w.x a + w.y b + w.z c
static inline Vec vec_blend(const Vec w, const Vec a, const Vec b, const Vec c) {
  return vec(w.x * a.x + w.y * b.x + w.z * c.x, w.x * a.y + w.y * b.y + w.z * c.y,
             w.x * a.z + w.y * b.z + w.z * c.z);
}

#endif
