// SPDX-License-Identifier: MIT
// The kinds of light there are, by their names in scene files and in glTF: the one list of them on the host. What a kind
// means is switched over without a default, so that a new one does not compile until it means something everywhere.
#pragma once

#include <algorithm>
#include <cmath>
#include <string_view>

#include "kernels/shared/light.h"
#include "support/error.hpp"
#include "support/named_enum.hpp"

namespace clpv {

enum class LightKind : unsigned {
  directional = CLPV_LIGHT_DIRECTIONAL,
  spot = CLPV_LIGHT_SPOT,
  point = CLPV_LIGHT_POINT,
};

template <>
inline constexpr auto kNames<LightKind> = name_list("directional", "spot", "point");

/// Throws Error(bad_input) for a number that is no kind.
inline LightKind kind_of(const ClpvLight& light) {
  const auto kinds = values_of<LightKind>();
  if (light.kind < kinds.size()) return kinds[light.kind];
  throw Error(ExitCode::bad_input, "light of kind {}: allowed: 0..{} ({})", light.kind, kinds.size() - 1,
              fmt::join(names_of<LightKind>(), ", "));
}

/// Sets the cone of a spot light as KHR_lights_punctual means it. Angles [rad] from the axis: full intensity within `inner`, none beyond `outer` > inner.
inline void set_cone(ClpvLight& light, double inner, double outer) {
  constexpr double kNarrowest = 0.001;  // the extension's own guard against inner == outer
  light.cone_scale = static_cast<float>(1.0 / std::max(kNarrowest, std::cos(inner) - std::cos(outer)));
  light.cone_offset = static_cast<float>(-std::cos(outer) * light.cone_scale);
}

}  // namespace clpv
