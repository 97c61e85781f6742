// SPDX-License-Identifier: MIT
// The sweeps of a cascade in order, as data (docs/method.md, 'The sweep', 'More bounces', 'Media').
#pragma once

#include <vector>

#include "options/choices.hpp"

namespace clpv {

/// Light that a sweep starts from. I: injected light; R: reflectors; S: their series; D: incident
/// flux of the last sweep, D_1 of the one before it.
enum class SweptLight {
  injected,        ///< I
  reflected,       ///< I + R D
  only_reflected,  ///< R D
  series,          ///< I + R D_1 + S D
};

struct SweepStep {
  SweptLight light;
  bool all_directions = false;  ///< false: one per bin, enough for incident flux
  bool dark_border = false;     ///< true: no light enters from the coarser cascade or the sky
  bool scattered = false;       ///< true: a medium scatters the last sweep's light too
};

/// The last step has all directions, and its result is the light of the cascade. `scatters`: there
/// is a medium that scatters light.
std::vector<SweepStep> sweep_plan(Bounces bounces, bool scatters);

}  // namespace clpv
