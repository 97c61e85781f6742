// SPDX-License-Identifier: MIT
// What a channel of a glTF animation changes, by the names of the format.
#pragma once

#include "support/named_enum.hpp"

namespace clpv {

enum class GltfPath : unsigned {
  translation,
  rotation,
  scale,
  weights,  ///< of morph targets
  pointer,  ///< whatever an extension (KHR_animation_pointer) says
};

template <>
inline constexpr auto kNames<GltfPath> = name_list("translation", "rotation", "scale", "weights", "pointer");

}  // namespace clpv
