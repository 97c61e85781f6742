// SPDX-License-Identifier: MIT
// The sweeps of a cascade in order, as data (docs/method.md, 'The sweep', 'More bounces', 'Media').
#pragma once

#include <vector>

#include "options/choices.hpp"

namespace clpv {

/// Light that a sweep starts from. I: injected light; R: reflectors; S, E: their series
/// (kernels/sweep/bounce.cl); D: incident flux of the last sweep, D_1 of the one before it. In a
/// medium that scatters, each sweep adds one reflection and one scattering.
enum class SweptLight {
  injected,   ///< I
  reflected,  ///< I + R D
  relaxed,    ///< I + E D
  series,     ///< I + R D_1 + S (D - D_1)
};

struct SweepStep {
  SweptLight light;
  bool scattered = false;  ///< true: a medium scatters the last sweep's light too
};

/// The result of the last step is the light of the cascade. `scatters`: there
/// is a medium that scatters light. `before_series`: sweeps before the series of all bounces.
std::vector<SweepStep> sweep_plan(Bounces bounces, bool scatters, int before_series);

}  // namespace clpv
