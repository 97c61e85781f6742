// SPDX-License-Identifier: MIT
#include "quality/baseline.hpp"

#include <chrono>
#include <cmath>

#include "baselines/filter.hpp"
#include "baselines/methods.hpp"
#include "pathtracer/path_tracer.hpp"
#include "scene/emission.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/median.hpp"

namespace clpv {
namespace {

constexpr unsigned kMaxSamples = 1u << 16, kMaxStride = 4;
constexpr int kPasses = 4;      // of the filter: its last taps are 8 pixels away; more blur Cornell's corners
constexpr int kFillPasses = 3;  // reach the next computed pixels at kMaxStride
constexpr unsigned kInterleave = 4;
constexpr double kFarthest = 2;      // extrapolation of samples
constexpr int kCorrections = 3;      // of the number of samples
constexpr double kTolerance = 0.05;  // of the time

bool filters(Baseline baseline) {
  return baseline == Baseline::paths_filtered || baseline == Baseline::vpl_interleaved;
}
bool lights_by_rsm(Baseline baseline) {
  return baseline == Baseline::vpl || baseline == Baseline::vpl_interleaved;
}
bool has_probes(Baseline baseline) {
  return baseline == Baseline::ddgi_first || baseline == Baseline::ddgi_converged;
}

/// Light of all pixels from one in `stride` x `stride`, by the joint bilateral filter.
baselines::Irradiance upsampled(const baselines::View& view, baselines::Irradiance computed,
                                unsigned stride) {
  if (stride == 1) return computed;
  baselines::Irradiance image = baselines::wavelet_filter(view, computed, kFillPasses);
  baselines::fill(view, image, computed, stride);
  return image;
}

baselines::Irradiance point_lights(const baselines::View& view, const BaselineBudget& budget, unsigned count,
                                   unsigned interleave, unsigned stride) {
  const std::vector<baselines::PointLight> lights = baselines::draw_lights(budget.rsms, count);
  baselines::Irradiance computed = baselines::light_by(view, lights, interleave, stride);
  if (interleave > 1) computed = baselines::joint_bilateral(view, computed, baselines::block_taps(stride));
  return upsampled(view, std::move(computed), stride);
}

baselines::Irradiance paths(const baselines::View& view, bool filter, unsigned samples, unsigned stride) {
  const baselines::Irradiance computed = baselines::trace_paths(view, samples, stride);
  baselines::Irradiance image = filter ? baselines::wavelet_filter(view, computed, kPasses) : computed;
  if (stride > 1) baselines::fill(view, image, computed, stride);
  return image;
}

struct Timed {
  baselines::Irradiance image;
  double ms;
};

/// What a number of samples takes, with the RSMs that it needs; of one frame.
struct Runner {
  Baseline baseline;
  const baselines::View& view;
  const BaselineBudget& budget;
  std::map<std::string, double>& settings;

  Timed operator()(unsigned samples, unsigned stride, unsigned frames = 1) const {
    const auto start = std::chrono::steady_clock::now();
    baselines::Irradiance image = run_baseline(baseline, view, budget, samples, stride, frames, settings);
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
    return {std::move(image), taken.count() / frames + (lights_by_rsm(baseline) ? budget.rsm_ms : 0)};
  }
};

struct Plan {
  unsigned samples = 1, stride = 1;
};

/// Doubles the samples up to half of the budget, then extrapolates, up to kFarthest times as many since times are noisy. Leaves
/// out pixels only if one sample for each takes too long.
Plan plan_for(const Runner& run, double budget_ms) {
  Plan plan;
  run(1, 1);  // fills caches
  double one = run(1, 1).ms;
  while (one > budget_ms && plan.stride < kMaxStride) {
    plan.stride *= 2;
    one = run(1, plan.stride).ms;
  }
  if (one > budget_ms) return plan;
  double ms = one;
  do {
    plan.samples *= 2;
    ms = run(plan.samples, plan.stride).ms;
  } while (ms < budget_ms / 2 && plan.samples < kMaxSamples);
  const double each = (ms - one) / (plan.samples - 1), most = kFarthest * plan.samples;
  const double fitting = each > 0 ? 1 + (budget_ms - one) / each : most;
  plan.samples = static_cast<unsigned>(std::clamp(fitting, 1.0, std::min(most, double{kMaxSamples})));
  return plan;
}

}  // namespace

BaselineBudget baseline_budget(Session& session, Frame& frame, const SceneCamera& camera, int frames) {
  BaselineBudget budget;
  std::map<std::string, std::vector<double>> shared;
  std::vector<double> budgets, rsm;
  const int coarsest = frame.options().cascades - 1;
  for (int i = 0; i <= frames; ++i) {
    frame.invalidate_light();
    frame.render(camera);
    std::map<std::string, double> stages;
    double rest = 0, rsms = 0;
    for (const StageTime& time : session.timeline().times()) {
      const Pass pass = time.mark.pass;
      if (pass == Pass::rasterize_camera || pass == Pass::rasterize_shadow || pass == Pass::shade) {
        stages[std::string(name_of(pass))] += time.ms;
      } else {
        rest += time.ms;
      }
      if (pass == Pass::rasterize_rsm && time.mark.cascade == coarsest) rsms += time.ms;
    }
    if (i == 0) continue;  // the first launch compiles kernels
    budgets.push_back(rest), rsm.push_back(rsms);
    for (const auto& [stage, ms] : stages) shared[stage].push_back(ms);
  }
  budget.budget_ms = median(budgets), budget.rsm_ms = median(rsm);
  for (const auto& [stage, values] : shared) budget.shared_ms[stage] = median(values);
  budget.rsms = frame.read_rsms(coarsest);
  budget.grids = frame.light().grids;
  return budget;
}

void require_baseline(Baseline baseline, const Scene& scene, int bounces, Show show) {
  const std::string_view name = name_of(baseline);
  if (scene.medium)
    throw Error(ExitCode::usage, "baseline {}: found a scene with a medium; allowed: without", name);
  if (show != Show::indirect && show != Show::irradiance)
    throw Error(ExitCode::usage, "baseline {}: found view '{}'; allowed: indirect, irradiance", name,
                name_of(show));
  if (lights_by_rsm(baseline) && (scene.sky || emits(scene))) {
    throw Error(ExitCode::usage,
                "baseline {}: found a sky or emissive surfaces, which no RSM has; allowed: lights", name);
  }
  if ((lights_by_rsm(baseline) || has_probes(baseline)) && bounces != 1)
    throw Error(ExitCode::usage, "baseline {}: found more than one bounce; allowed: bounces 1", name);
}

baselines::Irradiance run_baseline(Baseline baseline, const baselines::View& view,
                                   const BaselineBudget& budget, unsigned samples, unsigned stride,
                                   unsigned frames, std::map<std::string, double>& settings) {
  stop_if_interrupted();
  switch (baseline) {
    case Baseline::paths:
    case Baseline::paths_filtered:
      settings["paths_per_pixel"] = samples;
      return paths(view, baseline == Baseline::paths_filtered, samples, stride);
    case Baseline::vpl:
      settings["vpls"] = settings["vpls_per_pixel"] = samples;
      return point_lights(view, budget, samples, 1, stride);
    case Baseline::vpl_interleaved:
      settings["vpls"] = kInterleave * kInterleave * samples, settings["vpls_per_pixel"] = samples;
      return point_lights(view, budget, kInterleave * kInterleave * samples, kInterleave, stride);
    case Baseline::ddgi_first:
    case Baseline::ddgi_converged: {
      baselines::Probes probes(view, budget.grids);
      baselines::Irradiance image;
      for (unsigned frame = 0; frame < frames; ++frame) {
        stop_if_interrupted();
        image = upsampled(view, probes.render(samples, stride), stride);
      }
      settings["rays_per_probe"] = samples, settings["probes"] = static_cast<double>(probes.count());
      return image;
    }
  }
  return baselines::Irradiance();
}

MeasuredBaseline measure_baseline(Baseline baseline, const baselines::View& view,
                                  const BaselineBudget& budget, const reference::GroundTruth& truth,
                                  Show show, int runs) {
  require_baseline(baseline, view.scene(), view.bounces(), show);
  MeasuredBaseline measured;
  QualityCell& cell = measured.cell;
  const Runner run{baseline, view, budget, cell.settings};
  Plan plan = plan_for(run, budget.budget_ms);
  Timed last;
  double taken = 0;
  for (int correction = 0;; ++correction) {
    std::vector<double> times;
    for (int i = 0; i < runs; ++i) times.push_back((last = run(plan.samples, plan.stride)).ms);
    taken = median(times);
    const double ratio = budget.budget_ms / taken;
    const auto better = static_cast<unsigned>(std::clamp(plan.samples * ratio, 1.0, double{kMaxSamples}));
    if (std::abs(ratio - 1) <= kTolerance || better == plan.samples || correction == kCorrections) break;
    plan.samples = better;
  }
  if (baseline == Baseline::ddgi_converged) {
    last = run(plan.samples, plan.stride, kConvergedFrames);
    taken = last.ms;
    cell.settings["frames"] = kConvergedFrames;
  }
  measured.image = traced_view(view.with(last.image), show);
  fill_errors(cell, measured.image, truth, show);
  cell.settings.insert(
      {{"budget_ms", budget.budget_ms}, {"stride", plan.stride}, {"threads", view.threads()}});
  if (filters(baseline)) cell.settings["filter_passes"] = baseline == Baseline::paths_filtered ? kPasses : 1;
  cell.from_events = false;
  cell.compute_units = static_cast<unsigned>(view.threads());
  cell.stage_ms = budget.shared_ms;
  cell.stage_ms["baseline"] = taken;
  for (const auto& [stage, ms] : cell.stage_ms) cell.frame_ms += ms;
  return measured;
}

}  // namespace clpv
