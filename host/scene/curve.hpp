// SPDX-License-Identifier: MIT
// A quantity that changes with time by going through keys. In double; what is shown rounds last.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <span>
#include <vector>

#include "support/named_enum.hpp"

namespace clpv {

/// How a curve goes from key to key. The names are glTF's.
enum class Interpolation : unsigned {
  linear,        ///< evenly; rotations and directions along the shorter great circle
  step,          ///< not at all, until the next key
  cubic_spline,  ///< Hermite's cubic, by the value and the tangents of each key
};

template <>
inline constexpr auto kNames<Interpolation> = name_list("LINEAR", "STEP", "CUBICSPLINE");

/// Before the first key and after the last one it stands still.
struct Curve {
  Interpolation interpolation = Interpolation::linear;
  std::size_t components = 1;
  std::vector<double> times;  ///< [s], at least one, strictly rising
  /// `components` numbers a key; of a cubic spline three times as many: the tangent it is reached with, its value, the
  /// tangent it is left with, both tangents a second (glTF 2.0, appendix C.5).
  std::vector<double> values;
};

/// Each component by itself, into `out`, which has as many.
void evaluate(const Curve& curve, double seconds, std::span<double> out);

/// Of three components.
glm::dvec3 vector_at(const Curve& curve, double seconds);

/// Of three components that are a unit vector at each key, no two neighbours opposite each other: a unit vector, along the
/// great circle between them. Not for cubic splines.
glm::dvec3 direction_at(const Curve& curve, double seconds);

/// Of four components x, y, z, w, unit quaternions at each key: their spherical interpolation by the shorter way. A cubic
/// spline's is made unit; of length 0 where it passes through no rotation.
glm::dquat rotation_at(const Curve& curve, double seconds);

}  // namespace clpv
