// SPDX-License-Identifier: MIT
// The stages there are, and what the timeline tells apart of them: the one list for `clpv check`, the times of a frame and
// the benchmarks. A new one that is not everywhere it must be does not compile.
#pragma once

#include "support/named_enum.hpp"

namespace clpv {

/// As the house files them: kernels, what launches them, CPU reference, check and test of one stem. `sizes`, the layout of structs
/// that both sides share, is none of a frame's: it is checked before all others.
enum class Stage {
  sizes,
  rasterize,
  emit,
  inject,
  blockers,
  reflectors,
  propagate,
  sweep,
  bounce,
  visibility,
  gather,
  shade
};

template <>
inline constexpr auto kNames<Stage> = name_list("sizes", "rasterize", "emit", "inject", "blockers",
                                                "reflectors", "propagate", "sweep", "bounce", "visibility",
                                                "gather", "shade");

/// A part of a frame with a time of its own: a stage, or what it does for one purpose. `whole`: what a benchmark times as
/// one, whatever it launches.
enum class Pass {
  rasterize_camera,
  rasterize_shadow,  ///< a light
  rasterize_rsm,     ///< a cascade and light
  emit,              ///< points of emissive surfaces
  inject_light,      ///< a cascade, as are the next five
  inject_geometry,
  blockers,
  reflectors,
  propagate,   ///< in steps, or by a sweep and its bounces
  visibility,  ///< a cascade
  gather,
  shade,
  whole,
};

template <>
inline constexpr auto kNames<Pass> = name_list("rasterize-camera", "rasterize-shadow", "rasterize-rsm",
                                               "emit", "inject-light", "inject-geometry", "blockers",
                                               "reflectors", "propagate", "visibility", "gather", "shade",
                                               "whole");

}  // namespace clpv
