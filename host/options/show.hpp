// SPDX-License-Identifier: MIT
// What an image can show of a frame: the library's View, by its names. Units and meaning in kernels/shared/shade.h.
#pragma once

#include "clpv/renderer.hpp"
#include "kernels/shared/shade.h"
#include "support/named_enum.hpp"

namespace clpv {

using Show = View;

static_assert(static_cast<int>(Show::full) == CLPV_SHOW_FULL &&
              static_cast<int>(Show::depth) == CLPV_SHOW_DEPTH);

/// Whether a sky is seen where no surface is.
constexpr bool shows_sky(Show show) {
  return show == Show::full || show == Show::direct;
}

template <>
inline constexpr auto kNames<Show> = name_list("full", "direct", "indirect", "irradiance", "albedo", "normal",
                                               "depth");

}  // namespace clpv
