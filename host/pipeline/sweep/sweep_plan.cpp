// SPDX-License-Identifier: MIT
#include "pipeline/sweep/sweep_plan.hpp"

#include "basis/bounce.hpp"

namespace clpv {
namespace {

/// `sweeps` with one more reflection each, then the last sweep.
std::vector<SweepStep> bounced_plan(int sweeps, SweptLight last, bool scattered) {
  std::vector<SweepStep> plan{{.light = SweptLight::injected}};
  while (static_cast<int>(plan.size()) < sweeps)
    plan.push_back({.light = SweptLight::reflected, .scattered = scattered});
  if (last == SweptLight::series && sweeps > kLeastSeriesSweeps)
    plan[1].light = SweptLight::relaxed;
  plan.push_back({.light = last, .scattered = scattered});
  return plan;
}

}  // namespace

std::vector<SweepStep> sweep_plan(Bounces bounces, bool scatters, int before_series) {
  switch (bounces) {
    case Bounces::automatic:
    case Bounces::one:
      return {{.light = SweptLight::injected}};
    case Bounces::two:
      return bounced_plan(1, SweptLight::reflected, scatters);
    case Bounces::all:
      return scatters ? bounced_plan(kScatteredSweeps, SweptLight::reflected, true)
                      : bounced_plan(before_series, SweptLight::series, false);
  }
  return {};
}

}  // namespace clpv
