// SPDX-License-Identifier: MIT
// What a channel of a glTF animation changes, by the names of the format.
#pragma once

#include <string_view>

#include "support/named_enum.hpp"

namespace clpv {

enum class GltfPath : unsigned {
  translation,
  rotation,
  scale,
  weights,  ///< of morph targets
  pointer,  ///< whatever an extension (KHR_animation_pointer) says
};

constexpr std::string_view name_of(GltfPath path) {
  switch (path) {
    case GltfPath::translation:
      return "translation";
    case GltfPath::rotation:
      return "rotation";
    case GltfPath::scale:
      return "scale";
    case GltfPath::weights:
      return "weights";
    case GltfPath::pointer:
      return "pointer";
  }
  return {};
}

}  // namespace clpv
