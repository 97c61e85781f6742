// SPDX-License-Identifier: MIT
#include "baselines/baseline.hpp"

#include <chrono>
#include <cmath>

#include "baselines/filter.hpp"
#include "baselines/methods.hpp"
#include "baselines/radiance_cascades.hpp"
#include "pathtracer/path_tracer.hpp"
#include "scene/emission.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "support/statistics.hpp"
#include "times/frame_times.hpp"

namespace clpv {
namespace {

constexpr unsigned kMaxSamples = 1u << 16, kMaxStride = 4;
// Passes of the filter: its last taps are 8 pixels away; more blur Cornell's corners.
constexpr int kPasses = 4;
constexpr unsigned kInterleave = 4;
constexpr double kFarthest = 2;      // extrapolation of samples
constexpr int kCorrections = 3;      // corrections of the number of samples
constexpr double kTolerance = 0.05;  // share of the time

bool filters(Baseline baseline) {
  return baseline == Baseline::paths_filtered || baseline == Baseline::vpl_interleaved;
}
bool lights_by_rsm(Baseline baseline) {
  return baseline == Baseline::vpl || baseline == Baseline::vpl_interleaved;
}
bool has_probes(Baseline baseline) {
  return baseline == Baseline::ddgi_first || baseline == Baseline::ddgi_converged;
}

bool has_cascades(Baseline baseline) {
  return baseline == Baseline::radiance_cascades || baseline == Baseline::radiance_cascades_fine;
}

/// Settings of radiance cascades by the number of samples, 12 directions each, and the stride of
/// pixels, which is that of probes too. Searched: lab/docs/experiments.md.
baselines::RadianceCascadeSettings cascade_settings(unsigned samples, unsigned stride) {
  return {.side = static_cast<unsigned>(std::sqrt(double(samples))),
          .spacing = static_cast<float>(stride),
          .first = 4,
          .ratio = 4,
          .cascades = 2};
}
constexpr baselines::RadianceCascadeSettings kFineCascades{
    .side = 4, .spacing = 0.5f, .first = 8, .cascades = 2};

/// The fewest samples that a method gets before it leaves out pixels. Below them its errors are
/// larger than those of interpolation.
unsigned fewest_samples(Baseline baseline) {
  return lights_by_rsm(baseline)                   ? 16
         : has_probes(baseline)                    ? 8
         : baseline == Baseline::radiance_cascades ? 4
         : baseline == Baseline::paths_filtered    ? 2
                                                   : 1;
}

struct Timed {
  baselines::Irradiance image;
  double ms;
};

/// Runs a method with a number of samples, in one of `stride` x `stride` pixels. The time is that
/// of one frame, with the RSMs that it needs.
class Runner {
 public:
  Runner(Baseline baseline, const baselines::View& view, const BaselineBudget& budget)
      : baseline_(baseline), budget_(budget) {
    for (unsigned stride = 1; stride <= kMaxStride; stride *= 2)
      views_.emplace(stride, view.thinned(stride));
  }

  Timed operator()(unsigned samples, unsigned stride, unsigned frames = 1) {
    const auto start = std::chrono::steady_clock::now();
    baselines::Irradiance image = run_baseline(baseline_, views_.at(1), views_.at(stride), budget_,
                                               samples, frames, settings_);
    const std::chrono::duration<double, std::milli> taken =
        std::chrono::steady_clock::now() - start;
    return {std::move(image),
            taken.count() / frames + (lights_by_rsm(baseline_) ? budget_.rsm_ms : 0)};
  }
  Baseline baseline() const { return baseline_; }
  const std::map<std::string, double>& settings() const { return settings_; }  ///< the last

 private:
  Baseline baseline_;
  const BaselineBudget& budget_;
  std::map<unsigned, baselines::View> views_;  ///< by stride
  std::map<std::string, double> settings_;
};

struct Plan {
  unsigned samples, stride;
};

/// Leaves out pixels until the fewest samples fit. Then doubles the samples up to half of the
/// budget and extrapolates, up to kFarthest times as many since times are noisy.
Plan plan_for(Runner& run, double budget_ms) {
  const unsigned fewest = fewest_samples(run.baseline());
  Plan plan{fewest, 1};
  run(fewest, 1);  // fills caches
  double ms = run(fewest, 1).ms;
  while (ms > budget_ms && plan.stride < kMaxStride) {
    plan.stride *= 2;
    ms = run(fewest, plan.stride).ms;
  }
  const double one = plan.samples > 1 ? run(1, plan.stride).ms : ms;
  while (ms < budget_ms / 2 && plan.samples < kMaxSamples) {
    plan.samples *= 2;
    ms = run(plan.samples, plan.stride).ms;
  }
  if (plan.samples == 1) ms = run(plan.samples = 2, plan.stride).ms;
  const double each = (ms - one) / (plan.samples - 1), most = kFarthest * plan.samples;
  const double fitting = each > 0 ? 1 + (budget_ms - one) / each : most;
  plan.samples =
      static_cast<unsigned>(std::clamp(fitting, 1.0, std::min(most, double{kMaxSamples})));
  return plan;
}

}  // namespace

BaselineBudget baseline_budget(Session& session, Frame& frame, const SceneCamera& camera,
                               int frames) {
  const int coarsest = frame.options().cascades - 1;
  const auto shared = [](const StageMark& mark) {
    return mark.pass == Pass::rasterize_camera || mark.pass == Pass::rasterize_shadow ||
           mark.pass == Pass::shade;
  };
  const FrameTimes times = measure_frames(session, frame, camera, frames, 1);
  BaselineBudget budget;
  budget.budget_ms = median(times.sums([&](const StageMark& mark) { return !shared(mark); }));
  budget.rsm_ms = median(times.sums([&](const StageMark& mark) {
    return mark.pass == Pass::rasterize_rsm && mark.cascade == coarsest;
  }));
  budget.shared = times.pass_records();
  std::erase_if(budget.shared,
                [&](const TimeRecord& time) { return !shared({named<Pass>("pass", time.stage)}); });
  budget.rsms = frame.read_rsms(coarsest);
  budget.grids = frame.light().grids;
  return budget;
}

void require_baseline(Baseline baseline, const SceneData& scene, int bounces, Show show) {
  const std::string_view name = name_of(baseline);
  if (scene.medium)
    throw Error(ExitCode::usage, "baseline {}: found a scene with a medium; allowed: without",
                name);
  if (show != Show::indirect && show != Show::irradiance)
    throw Error(ExitCode::usage, "baseline {}: found view '{}'; allowed: indirect, irradiance",
                name, name_of(show));
  if (lights_by_rsm(baseline) && (scene.sky || emits(scene))) {
    throw Error(ExitCode::usage,
                "baseline {}: found a sky or emissive surfaces, which no RSM has; allowed: lights",
                name);
  }
  if ((lights_by_rsm(baseline) || has_probes(baseline) || has_cascades(baseline)) && bounces != 1)
    throw Error(ExitCode::usage, "baseline {}: found more than one bounce; allowed: bounces 1",
                name);
}

baselines::Irradiance run_baseline(Baseline baseline, const baselines::View& full,
                                   const baselines::View& thin, const BaselineBudget& budget,
                                   unsigned samples, unsigned frames,
                                   std::map<std::string, double>& settings) {
  stop_if_interrupted();
  const auto all_pixels = [&](baselines::Irradiance image) {
    return thin.stride() == 1 ? image : baselines::upsampled(full, thin, image);
  };
  const auto vpls = [&](unsigned interleave) {
    const unsigned count = interleave * interleave * samples;
    settings["vpls"] = count, settings["vpls_per_pixel"] = samples;
    return baselines::light_by(thin, baselines::draw_lights(budget.rsms, count), interleave);
  };
  const auto cascades = [&](const baselines::View& view,
                            const baselines::RadianceCascadeSettings& chosen) {
    baselines::CascadedImage image = baselines::radiance_cascades(view, budget.grids, chosen);
    settings["directions"] = 12 * chosen.side * chosen.side,
    settings["spacing"] = double{chosen.spacing};
    settings["probes"] = static_cast<double>(image.probes);
    settings["megabytes"] = static_cast<double>(image.bytes) / 1e6;
    return std::move(image.irradiance);
  };
  switch (baseline) {
    case Baseline::paths:
      settings["paths_per_pixel"] = samples;
      return all_pixels(baselines::trace_paths(thin, samples));
    case Baseline::paths_filtered:
      settings["paths_per_pixel"] = samples;
      return all_pixels(
          baselines::wavelet_filter(thin, baselines::trace_paths(thin, samples), kPasses));
    case Baseline::vpl:
      return all_pixels(vpls(1));
    case Baseline::vpl_interleaved:
      return all_pixels(
          baselines::joint_bilateral(thin, vpls(kInterleave), baselines::block_taps()));
    case Baseline::ddgi_first:
    case Baseline::ddgi_converged: {
      baselines::Probes probes(thin, budget.grids);
      baselines::Irradiance image;
      for (unsigned frame = 0; frame < frames; ++frame) {
        stop_if_interrupted();
        image = all_pixels(probes.render(samples));
      }
      settings["rays_per_probe"] = samples,
      settings["probes"] = static_cast<double>(probes.count());
      return image;
    }
    case Baseline::radiance_cascades:
      return all_pixels(cascades(thin, cascade_settings(samples, thin.stride())));
    case Baseline::radiance_cascades_fine:
      return cascades(full, kFineCascades);
  }
  return baselines::Irradiance();
}

MeasuredBaseline measure_baseline(Baseline baseline, const baselines::View& view,
                                  const BaselineBudget& budget, const GroundTruth& truth, Show show,
                                  int runs) {
  require_baseline(baseline, view.scene(), view.bounces(), show);
  MeasuredBaseline measured;
  QualityCell& cell = measured.cell;
  Runner run(baseline, view, budget);
  const bool any_time = baseline == Baseline::radiance_cascades_fine;
  Plan plan = any_time ? Plan{1, 1} : plan_for(run, budget.budget_ms);
  Timed last;
  TimeRecord taken;
  for (int correction = 0;; ++correction) {
    std::vector<double> times;
    for (int i = 0; i < runs; ++i) times.push_back((last = run(plan.samples, plan.stride)).ms);
    taken = time_record("baseline", times);
    if (any_time) break;
    const double ratio = budget.budget_ms / taken.median;
    const auto better =
        static_cast<unsigned>(std::clamp(plan.samples * ratio, 1.0, double{kMaxSamples}));
    if (std::abs(ratio - 1) <= kTolerance || better == plan.samples || correction == kCorrections)
      break;
    plan.samples = better;
  }
  if (baseline == Baseline::ddgi_converged) {
    last = run(plan.samples, plan.stride, kConvergedFrames);
    taken = time_record("baseline", {last.ms});
  }
  measured.image = traced_view(view.with(last.image), show);
  fill_errors(cell, measured.image, truth, show);
  cell.settings = run.settings();
  cell.settings.insert(
      {{"budget_ms", budget.budget_ms}, {"stride", plan.stride}, {"threads", view.threads()}});
  if (baseline == Baseline::ddgi_converged) cell.settings["frames"] = kConvergedFrames;
  if (filters(baseline))
    cell.settings["filter_passes"] = baseline == Baseline::paths_filtered ? kPasses : 1;
  cell.from_events = false;
  cell.compute_units = static_cast<unsigned>(view.threads());
  cell.times = budget.shared;
  cell.times.push_back(taken);
  double frame_ms = 0;
  for (const TimeRecord& time : cell.times) frame_ms += time.median;
  cell.times.insert(cell.times.begin(), time_record("frame", {frame_ms}));
  return measured;
}

}  // namespace clpv
