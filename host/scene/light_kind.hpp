// SPDX-License-Identifier: MIT
// Kinds of lights, with their names in scene files and glTF. Switches over them have no default, so
// that the compiler finds all places for a new kind.
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "clpv/scene.hpp"
#include "kernels/shared/light.h"
#include "support/error.hpp"
#include "support/named_enum.hpp"

namespace clpv {

static_assert(static_cast<unsigned>(LightKind::directional) == CLPV_LIGHT_DIRECTIONAL &&
              static_cast<unsigned>(LightKind::spot) == CLPV_LIGHT_SPOT &&
              static_cast<unsigned>(LightKind::point) == CLPV_LIGHT_POINT);

template <>
inline constexpr auto kNames<LightKind> = name_list("directional", "spot", "point");

/// Kind of a light. Throws Error(bad_input) for an invalid number.
inline LightKind kind_of(const ClpvLight& light) {
  const auto kinds = values_of<LightKind>();
  if (light.kind < kinds.size()) return kinds[light.kind];
  throw Error(ExitCode::bad_input, "light kind: found {}; allowed: 0 to {} ({})", light.kind,
              kinds.size() - 1, fmt::join(names_of<LightKind>(), ", "));
}

/// Sets the cone of a spot light by KHR_lights_punctual. Angles are from the axis [rad], 0 <= inner
/// <= outer, 0 < outer: full intensity within `inner`, 0 beyond `outer`. Equal ones give a hard
/// edge, as sharp as floats resolve. A difference of cosines below 0.001, which the extension's
/// code rounds up, is computed as it is.
inline void set_cone(ClpvLight& light, double inner, double outer) {
  constexpr double kNarrow = 0.001;        // difference of cosines
  constexpr double kResolution = 0x1p-23;  // a float's relative resolution
  const double difference = std::cos(inner) - std::cos(outer);
  light.narrow_cone = difference < kNarrow;
  if (!light.narrow_cone) {
    light.cone_scale = static_cast<float>(1.0 / difference);
    light.cone_offset = static_cast<float>(-std::cos(outer) * light.cone_scale);
    return;
  }
  const double below_one = 2 * std::pow(std::sin(outer / 2), 2);  // 1 - cos(outer)
  const double edge = 2 * std::sin((outer + inner) / 2) * std::sin((outer - inner) / 2);
  light.cone_scale = static_cast<float>(1.0 / std::max(edge, kResolution * below_one));
  light.cone_offset = static_cast<float>(below_one * light.cone_scale);
}

/// Angles of a spot light's cone [rad], as set_cone() takes them.
struct Cone {
  double inner, outer;
};

inline Cone cone_of(const ClpvLight& light) {
  // The ramp is 0 and 1 where c is these.
  const double scale = light.cone_scale, at_outer = -light.cone_offset / scale,
               at_inner = (1 - light.cone_offset) / scale;
  const auto angle = [&light](double c) {
    return light.narrow_cone != 0 ? 2 * std::asin(std::sqrt(std::clamp(-c / 2, 0.0, 1.0)))
                                  : std::acos(std::clamp(c, -1.0, 1.0));
  };
  return {angle(at_inner), angle(at_outer)};
}

}  // namespace clpv
