// SPDX-License-Identifier: MIT
// Quantities that an image can show: View with its names. kernels/shared/shade.h has meaning and units.
#pragma once

#include "clpv/renderer.hpp"
#include "kernels/shared/shade.h"
#include "support/named_enum.hpp"

namespace clpv {

using Show = View;

static_assert(static_cast<int>(Show::full) == CLPV_SHOW_FULL &&
              static_cast<int>(Show::depth) == CLPV_SHOW_DEPTH);

/// Returns true if the view shows the sky where there is no surface.
constexpr bool shows_sky(Show show) {
  return show == Show::full || show == Show::direct;
}

template <>
inline constexpr auto kNames<Show> = name_list("full", "direct", "indirect", "irradiance", "albedo", "normal",
                                               "depth");

}  // namespace clpv
