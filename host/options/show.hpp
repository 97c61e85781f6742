// SPDX-License-Identifier: MIT
// What an image can show of a frame.
#pragma once

#include "kernels/shared/shade.h"
#include "support/named_enum.hpp"

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

template <>
inline constexpr auto kNames<Show> = name_list("full", "direct", "indirect", "irradiance", "albedo", "normal",
                                               "depth");

}  // namespace clpv
