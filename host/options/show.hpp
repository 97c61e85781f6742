// SPDX-License-Identifier: MIT
// Quantities that an image can show: View with its names. kernels/shared/shade.h has meaning and
// units.
#pragma once

#include <array>

#include "clpv/renderer.hpp"
#include "kernels/shared/shade.h"
#include "support/error.hpp"
#include "support/named_enum.hpp"

namespace clpv {

using Show = View;

static_assert(static_cast<int>(Show::full) == CLPV_SHOW_FULL &&
              static_cast<int>(Show::depth) == CLPV_SHOW_DEPTH);

/// Returns true if the view shows the sky where there is no surface.
constexpr bool shows_sky(Show show) {
  return show == Show::full || show == Show::direct;
}

/// Returns true if the view shows light, which a display exposes.
constexpr bool shows_light(Show show) {
  return show != Show::albedo && show != Show::normal && show != Show::depth;
}

/// Returns true if the view has the light that a medium scatters towards the camera.
constexpr bool shows_medium(Show show) {
  return show == Show::full || show == Show::medium;
}

template <>
inline constexpr auto kNames<Show> = name_list("full", "direct", "indirect", "irradiance", "albedo",
                                               "normal", "depth", "medium", "cells");

/// Views of surfaces, which kernels shade. `medium` is computed by stage `medium`, `cells` drawn
/// by the host (raster/paint).
inline constexpr std::array kSurfaceViews{Show::full,       Show::direct, Show::indirect,
                                          Show::irradiance, Show::albedo, Show::normal,
                                          Show::depth};

/// Returns true if path tracing estimates the view by random paths. The others follow from primary
/// and shadow rays.
constexpr bool needs_paths(Show show) {
  return show == Show::full || show == Show::indirect || show == Show::irradiance ||
         show == Show::medium;
}

/// Throws Error(usage) for a view that the path tracer does not have.
inline void require_traceable(Show show) {
  if (show == Show::cells)
    throw Error(ExitCode::usage,
                "view: found 'cells', which path tracing does not have; allowed: the others");
}

}  // namespace clpv
