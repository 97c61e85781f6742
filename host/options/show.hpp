// SPDX-License-Identifier: MIT
// What an image can show of a frame.
#pragma once

#include <string_view>

#include "kernels/shared/shade.h"

namespace clpv {

/// Units and meaning in kernels/shared/shade.h. full = direct + indirect.
enum class Show : unsigned {
  full = CLPV_SHOW_FULL,
  direct = CLPV_SHOW_DIRECT,
  indirect = CLPV_SHOW_INDIRECT,
  irradiance = CLPV_SHOW_IRRADIANCE,
  albedo = CLPV_SHOW_ALBEDO,
  normal = CLPV_SHOW_NORMAL,
  depth = CLPV_SHOW_DEPTH,
};

/// Whether a sky is seen where no surface is.
constexpr bool shows_sky(Show show) {
  return show == Show::full || show == Show::direct;
}

constexpr std::string_view name_of(Show show) {
  switch (show) {
    case Show::full:
      return "full";
    case Show::direct:
      return "direct";
    case Show::indirect:
      return "indirect";
    case Show::irradiance:
      return "irradiance";
    case Show::albedo:
      return "albedo";
    case Show::normal:
      return "normal";
    case Show::depth:
      return "depth";
  }
  return {};
}

}  // namespace clpv
