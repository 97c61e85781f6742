// SPDX-License-Identifier: MIT
// Keyframe curves: quantities that change with time (glTF 2.0, appendix C), in double.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <span>
#include <vector>

#include "support/named_enum.hpp"

namespace clpv {

/// Interpolation between keys, with glTF's names.
enum class Interpolation : unsigned {
  linear,        ///< linear; rotations and directions spherically, along the shorter great circle
  step,          ///< constant until the next key
  cubic_spline,  ///< cubic Hermite spline by values and tangents
};

template <>
inline constexpr auto kNames<Interpolation> = name_list("LINEAR", "STEP", "CUBICSPLINE");

/// A curve is constant before its first key and after its last.
struct Curve {
  Interpolation interpolation = Interpolation::linear;
  std::size_t components = 1;
  std::vector<double> times;  ///< [s], at least one, strictly rising
  /// `components` numbers per key. A cubic spline has three times as many: in-tangent [1/s], value,
  /// out-tangent [1/s] (glTF 2.0, appendix C.5).
  std::vector<double> values;
};

/// Evaluates each component independently into `out`, of size `components`.
void evaluate(const Curve& curve, double seconds, std::span<double> out);

/// Evaluates a curve of three components.
glm::dvec3 vector_at(const Curve& curve, double seconds);

/// Evaluates a curve of unit vectors by spherical interpolation. Adjacent keys must not be
/// opposite. Not for cubic splines.
glm::dvec3 direction_at(const Curve& curve, double seconds);

/// Evaluates a curve of unit quaternions x, y, z, w by spherical interpolation along the shorter
/// arc. Cubic splines are normalised, unless their length is 0.
glm::dquat rotation_at(const Curve& curve, double seconds);

}  // namespace clpv
