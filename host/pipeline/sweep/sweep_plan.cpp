// SPDX-License-Identifier: MIT
#include "pipeline/sweep/sweep_plan.hpp"

#include "basis/bounce.hpp"

namespace clpv {
namespace {

/// In a medium that scatters, each sweep adds one reflection and one scattering.
std::vector<SweepStep> scattering_plan(int sweeps) {
  std::vector<SweepStep> plan{{.light = SweptLight::injected}};
  while (static_cast<int>(plan.size()) < sweeps)
    plan.push_back({.light = SweptLight::reflected, .scattered = true});
  plan.push_back({.light = SweptLight::reflected, .all_directions = true, .scattered = true});
  return plan;
}

}  // namespace

std::vector<SweepStep> sweep_plan(Bounces bounces, bool scatters) {
  switch (bounces) {
    case Bounces::one:
      return {{.light = SweptLight::injected, .all_directions = true}};
    case Bounces::two:
      if (scatters) return scattering_plan(1);
      return {{.light = SweptLight::injected},
              {.light = SweptLight::reflected, .all_directions = true}};
    case Bounces::all:
      if (scatters) return scattering_plan(kScatteredSweeps);
      return {{.light = SweptLight::injected},
              {.light = SweptLight::only_reflected, .dark_border = true},
              {.light = SweptLight::series, .all_directions = true}};
  }
  return {};
}

}  // namespace clpv
