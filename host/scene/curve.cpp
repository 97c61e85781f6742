// SPDX-License-Identifier: MIT
// Evaluates keyframe curves.
#include "scene/curve.hpp"

#include <algorithm>
#include <cmath>

namespace clpv {
namespace {

/// The interval between two keys that contains an instant.
struct KeyInterval {
  /// Key at the start of the interval, or the first or last key outside all intervals.
  std::size_t key;
  double fraction = 0;  ///< position in the interval, in [0, 1); 0 outside
  double duration = 0;  ///< [s]
};

KeyInterval interval_at(const Curve& curve, double seconds) {
  const auto after = std::upper_bound(curve.times.begin(), curve.times.end(), seconds);
  if (after == curve.times.begin()) return {0};
  const auto key = static_cast<std::size_t>(after - curve.times.begin()) - 1;
  if (after == curve.times.end()) return {key};
  const double duration = *after - curve.times[key];
  return {key, (seconds - curve.times[key]) / duration, duration};
}

/// Numbers of a key. In a cubic spline, `part` is 0 for the in-tangent, 1 for the value, 2 for the
/// out-tangent.
const double* key_of(const Curve& curve, std::size_t key, std::size_t part = 1) {
  const bool cubic = curve.interpolation == Interpolation::cubic_spline;
  return &curve.values[(cubic ? 3 * key + part : key) * curve.components];
}

void hermite(const Curve& curve, const KeyInterval& at, std::span<double> out) {
  const double t = at.fraction, t2 = t * t, t3 = t2 * t;
  const double* from = key_of(curve, at.key);
  const double* out_tangent = key_of(curve, at.key, 2);
  const double* to = key_of(curve, at.key + 1);
  const double* in_tangent = key_of(curve, at.key + 1, 0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = (2 * t3 - 3 * t2 + 1) * from[i] + at.duration * (t3 - 2 * t2 + t) * out_tangent[i] +
             (3 * t2 - 2 * t3) * to[i] + at.duration * (t3 - t2) * in_tangent[i];
  }
}

glm::dvec3 vector_of(const double* v) {
  return {v[0], v[1], v[2]};
}

glm::dquat rotation_of(const double* v) {
  return {v[3], v[0], v[1], v[2]};
}

}  // namespace

void evaluate(const Curve& curve, double seconds, std::span<double> out) {
  const KeyInterval at = interval_at(curve, seconds);
  const double* from = key_of(curve, at.key);
  if (at.fraction == 0 || curve.interpolation == Interpolation::step) {
    std::copy_n(from, out.size(), out.begin());
  } else if (curve.interpolation == Interpolation::cubic_spline) {
    hermite(curve, at, out);
  } else {
    const double* to = key_of(curve, at.key + 1);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] = (1 - at.fraction) * from[i] + at.fraction * to[i];
  }
}

glm::dvec3 vector_at(const Curve& curve, double seconds) {
  double v[3];
  evaluate(curve, seconds, v);
  return vector_of(v);
}

glm::dvec3 direction_at(const Curve& curve, double seconds) {
  const KeyInterval at = interval_at(curve, seconds);
  const glm::dvec3 from = vector_of(key_of(curve, at.key));
  if (at.fraction == 0 || curve.interpolation == Interpolation::step) return from;
  const glm::dvec3 to = vector_of(key_of(curve, at.key + 1));
  const double angle = std::atan2(glm::length(glm::cross(from, to)), glm::dot(from, to));
  if (angle < 1e-9) return from;  // equal up to rounding
  return glm::normalize(std::sin((1 - at.fraction) * angle) * from +
                        std::sin(at.fraction * angle) * to);
}

glm::dquat rotation_at(const Curve& curve, double seconds) {
  const KeyInterval at = interval_at(curve, seconds);
  if (at.fraction > 0 && curve.interpolation == Interpolation::linear) {
    const glm::dquat from = rotation_of(key_of(curve, at.key)),
                     to = rotation_of(key_of(curve, at.key + 1));
    return glm::normalize(glm::slerp(from, to, at.fraction));
  }
  double v[4];
  evaluate(curve, seconds, v);
  const glm::dquat rotation = rotation_of(v);
  const double length = glm::length(rotation);
  return length > 0 ? rotation / length : rotation;
}

}  // namespace clpv
