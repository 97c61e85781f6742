// SPDX-License-Identifier: MIT
// A spot light's cone as KHR_lights_punctual means it.
#pragma once

#include <algorithm>
#include <cmath>

#include "kernels/shared/light.h"

namespace clpv {

/// Angles [rad] from the axis: full intensity within `inner`, none beyond `outer` > inner.
inline void set_cone(ClpvLight& light, double inner, double outer) {
  constexpr double kNarrowest = 0.001;  // the extension's own guard against inner == outer
  light.cone_scale = static_cast<float>(1.0 / std::max(kNarrowest, std::cos(inner) - std::cos(outer)));
  light.cone_offset = static_cast<float>(-std::cos(outer) * light.cone_scale);
}

}  // namespace clpv
