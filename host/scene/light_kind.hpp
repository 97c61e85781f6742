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

/// Sets the cone of a spot light by KHR_lights_punctual. Angles are from the axis [rad]: full
/// intensity within `inner`, 0 beyond `outer` > inner.
inline void set_cone(ClpvLight& light, double inner, double outer) {
  constexpr double kMinDifference = 0.001;  // from the extension, for inner == outer
  light.cone_scale =
      static_cast<float>(1.0 / std::max(kMinDifference, std::cos(inner) - std::cos(outer)));
  light.cone_offset = static_cast<float>(-std::cos(outer) * light.cone_scale);
}

}  // namespace clpv
