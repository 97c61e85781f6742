// SPDX-License-Identifier: MIT
// Stages and timed passes: the list that `clpv check`, frame times and benchmarks share. A pass's
// name begins with its stage's and with no other's, since `clpv quality` sums its times so.
#pragma once

#include "support/named_enum.hpp"

namespace clpv {

/// A stage has one stem in most folders (CONTRIBUTING.md). `sizes` checks structs that host and
/// kernels share; it is not part of a frame and is checked first.
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
  near,
  medium,
  shade
};

template <>
inline constexpr auto kNames<Stage> = name_list("sizes", "rasterize", "emit", "inject", "blockers",
                                                "reflectors", "propagate", "sweep", "bounce",
                                                "visibility", "gather", "near", "medium", "shade");

/// A part of a frame that is timed separately: a stage, or one use of it. `whole`: everything that
/// a benchmark launches.
enum class Pass {
  rasterize_camera,
  rasterize_shadow,  ///< per light
  rasterize_rsm,     ///< of all lights; per cascade, or of all
  emit,              ///< points of emissive surfaces
  inject_light,      ///< per cascade, or of all; the next five are per cascade
  inject_geometry,
  blockers,
  reflectors,
  propagate,   ///< steps, or a sweep with its bounces and its scattering in a medium
  visibility,  ///< per cascade
  gather,
  near_trace,  ///< rays of the near field, while their hits are not cached
  near,        ///< light of the near field
  medium,      ///< light that a medium scatters towards the camera
  shade,
  whole,
};

template <>
inline constexpr auto kNames<Pass> = name_list("rasterize-camera", "rasterize-shadow",
                                               "rasterize-rsm", "emit", "inject-light",
                                               "inject-geometry", "blockers", "reflectors",
                                               "propagate", "visibility", "gather", "near-trace",
                                               "near", "medium", "shade", "whole");

}  // namespace clpv
