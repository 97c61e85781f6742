// SPDX-License-Identifier: MIT
#include "baselines/baseline.hpp"

#include <chrono>
#include <cmath>
#include <cstdlib>

#include "baselines/methods.hpp"
#include "baselines/radiance_cascades.hpp"
#include "basis/sampling.hpp"
#include "pathtracer/path_tracer.hpp"
#include "scene/emission.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"
#include "times/frame_times.hpp"
#include "times/time_record.hpp"

namespace clpv::baselines {

// Baseline: path tracing.

Irradiance trace_paths(const View& view, unsigned samples) {
  constexpr std::uint64_t kSeed = 2;  // the ground truth has other paths: its seed is 1
  Irradiance image(view.hits().size());
  view.for_each_pixel([&](pathtracer::PathSampler& sampler, std::size_t pixel) {
    glm::dvec3 sum(0);
    for (unsigned path = 0; path < samples; ++path)
      sum += sampler.indirect({*view.hits()[pixel]}, path, mix(mix(kSeed), pixel));
    image.set(pixel, glm::vec3(sum / double(samples)));
  });
  return image;
}

}  // namespace clpv::baselines

// The filter's inner loop runs along a row, one tap at a time, so that compilers vectorise it.

// Compile a function for the processor's widest vectors, as OpenCL drivers do with kernels, and a
// loop whose iterations do not depend on each other. Sanitizers do not support it.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CLPV_WIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#define CLPV_INDEPENDENT _Pragma("GCC ivdep")
#else
#define CLPV_WIDE
#define CLPV_INDEPENDENT
#endif

namespace clpv::baselines {
namespace {

// Distance of planes at which a tap's weight is 0, in pixel edges per pixel of distance. Tuned,
// like the power of the normals' cosine, on Sponza, the atrium and the Cornell box with two paths
// per pixel.
constexpr float kThickness = 2;

/// A range of a row's pixels.
struct Row {
  const float *px, *py, *pz, *nx, *ny, *nz, *density;
  const float *red, *green, *blue, *computed;
};

Row row_at(const Planes& surfaces, const Irradiance& image, std::size_t i) {
  return {surfaces[kPosition] + i,
          surfaces[kPosition + 1] + i,
          surfaces[kPosition + 2] + i,
          surfaces[kNormal] + i,
          surfaces[kNormal + 1] + i,
          surfaces[kNormal + 2] + i,
          surfaces[kDensity] + i,
          image[0] + i,
          image[1] + i,
          image[2] + i,
          image[3] + i};
}

/// Adds the weighted irradiance of `count` pixels `b` to the sums of pixels `a`, and the weights to
/// the fourth. A weight is `share` cos^4 (1 - d^2), cos of the normals, d the distance from a's
/// plane [thickness].
CLPV_WIDE void add_tap(Row a, Row b, std::size_t count, float share, float inverse_thickness,
                       float* __restrict red, float* __restrict green, float* __restrict blue,
                       float* __restrict sum) {
  CLPV_INDEPENDENT
  for (std::size_t i = 0; i < count; ++i) {
    const float dot = a.nx[i] * b.nx[i] + a.ny[i] * b.ny[i] + a.nz[i] * b.nz[i];
    const float cosine = dot > 0 ? dot : 0, square = cosine * cosine;
    const float off_plane = a.nx[i] * (b.px[i] - a.px[i]) + a.ny[i] * (b.py[i] - a.py[i]) +
                            a.nz[i] * (b.pz[i] - a.pz[i]);
    const float d = off_plane * a.density[i] * inverse_thickness, rest = 1 - d * d;
    const float weight = share * b.computed[i] * square * square * (rest > 0 ? rest : 0);
    red[i] += weight * b.red[i];
    green[i] += weight * b.green[i];
    blue[i] += weight * b.blue[i];
    sum[i] += weight;
  }
}

/// Divides the sums of a row's pixels by their weights.
void normalise(Irradiance& sums, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    const float scale = sums[3][i] > 0 ? 1 / sums[3][i] : 0;
    for (int c = 0; c < 3; ++c) sums[c][i] *= scale;
    sums[3][i] = sums[3][i] > 0 ? 1.0f : 0.0f;
  }
}

/// Maps a row of the full view to a thinned one: for each pixel, the thinned pixels before and
/// after it.
struct SpreadRow {
  Planes surfaces;
  Irradiance image;

  explicit SpreadRow(std::size_t width) : surfaces(kSurfacePlanes, width), image(width) {}

  /// Neighbour 0 or 1 of `row`; the image's weights are those of linear interpolation.
  void set(const View& thin, const Irradiance& from, std::size_t row, int neighbour) {
    const auto stride = static_cast<int>(thin.stride()), last = static_cast<int>(thin.width()) - 1;
    for (int x = 0; x < static_cast<int>(image.size()); ++x) {
      const float at = static_cast<float>(x - stride / 2) / static_cast<float>(stride),
                  before = std::floor(at);
      const std::size_t i =
          row * thin.width() + std::clamp(static_cast<int>(before) + neighbour, 0, last);
      for (std::size_t plane = 0; plane < kSurfacePlanes; ++plane)
        surfaces[plane][x] = thin.surfaces()[plane][i];
      for (int c = 0; c < 3; ++c) image[c][x] = from[c][i];
      image[3][x] = from[3][i] * (neighbour == 0 ? 1 - (at - before) : at - before);
    }
  }
};

}  // namespace

Irradiance joint_bilateral(const View& view, const Irradiance& image, std::span<const Tap> taps) {
  const auto width = static_cast<int>(view.width()), height = static_cast<int>(view.height());
  Irradiance sums(image.size());
  view.parallel_for(view.height(), 1, [&](pathtracer::PathSampler&, std::size_t row, std::size_t) {
    const int y = static_cast<int>(row);
    for (const Tap& tap : taps) {
      const int first = std::max(0, -tap.x), last = std::min(width, width - tap.x);
      if (y + tap.y < 0 || y + tap.y >= height || first >= last) continue;
      const std::size_t a = row * width + first, b = (row + tap.y) * width + first + tap.x;
      const auto reach = static_cast<float>(std::max({1, std::abs(tap.x), std::abs(tap.y)}));
      add_tap(row_at(view.surfaces(), image, a), row_at(view.surfaces(), image, b),
              static_cast<std::size_t>(last - first), tap.weight, 1 / (kThickness * reach),
              &sums[0][a], &sums[1][a], &sums[2][a], &sums[3][a]);
    }
    normalise(sums, row * width, (row + 1) * width);
  });
  return sums;
}

std::vector<Tap> block_taps() {
  std::vector<Tap> taps;
  for (int y = -1; y <= 2; ++y) {
    for (int x = -1; x <= 2; ++x) taps.push_back({x, y, 1});
  }
  return taps;
}

std::vector<Tap> wavelet_taps(int step) {
  std::vector<Tap> taps;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x)
      taps.push_back({x * step, y * step, (x == 0 ? 2.0f : 1) * (y == 0 ? 2.0f : 1)});
  }
  return taps;
}

Irradiance wavelet_filter(const View& view, const Irradiance& image, int passes) {
  Irradiance result = joint_bilateral(view, image, wavelet_taps(1));
  for (int pass = 1; pass < passes; ++pass)
    result = joint_bilateral(view, result, wavelet_taps(1 << pass));
  return result;
}

Irradiance upsampled(const View& full, const View& thin, const Irradiance& image) {
  const std::size_t width = full.width(), height = full.height(), stride = thin.stride();
  const auto last = static_cast<int>(thin.height()) - 1;
  Irradiance sums(width * height);
  // Bands of rows between the same two thinned rows: the first one starts above the image.
  full.parallel_for(
      thin.height() + 1, 1, [&](pathtracer::PathSampler&, std::size_t band, std::size_t) {
        SpreadRow spread(width);
        const int above = static_cast<int>(band) - 1,
                  start = above * static_cast<int>(stride) + static_cast<int>(stride) / 2;
        const std::size_t first = static_cast<std::size_t>(std::max(0, start)),
                          end = std::min<std::size_t>(
                              height, static_cast<std::size_t>(start + static_cast<int>(stride)));
        for (int i = 0; i < 4 && first < end; ++i) {
          const int row = std::clamp(above + i / 2, 0, last);
          spread.set(thin, image, static_cast<std::size_t>(row), i % 2);
          for (std::size_t y = first; y < end; ++y) {
            const float below =
                static_cast<float>(static_cast<int>(y) - start) / static_cast<float>(stride);
            const std::size_t at = y * width;
            add_tap(row_at(full.surfaces(), sums, at), row_at(spread.surfaces, spread.image, 0),
                    width, i < 2 ? 1 - below : below, 1 / (kThickness * static_cast<float>(stride)),
                    &sums[0][at], &sums[1][at], &sums[2][at], &sums[3][at]);
          }
        }
        for (std::size_t y = first; y < end; ++y) normalise(sums, y * width, (y + 1) * width);
      });
  full.for_each_pixel([&](pathtracer::PathSampler&, std::size_t pixel) {
    const std::size_t x = pixel % width / stride, y = pixel / width / stride;
    if (!sums.computed(pixel)) sums.set(pixel, image.at(y * thin.width() + x));
  });
  return sums;
}

}  // namespace clpv::baselines
namespace clpv {
namespace {

constexpr unsigned kMaxSamples = 1u << 16, kMaxStride = 4;
// Passes of the filter: its last taps are 8 pixels away; more blur Cornell's corners.
constexpr int kPasses = 4;
constexpr unsigned kInterleave = 4;
constexpr double kFarthest = 2;      // extrapolation of samples
constexpr int kCorrections = 3;      // corrections of the number of samples
constexpr double kTolerance = 0.05;  // share of the time

bool lights_by_rsm(Baseline baseline) {
  return baseline == Baseline::vpl || baseline == Baseline::vpl_interleaved;
}
bool has_probes(Baseline baseline) {
  return baseline == Baseline::ddgi_first || baseline == Baseline::ddgi_converged;
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
  const auto of_rsms = [](const StageMark& mark) { return mark.pass == Pass::rasterize_rsm; };
  budget.rsm_ms = median(times.sums(of_rsms)) / frame.options().cascades;
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
  const bool has_cascades =
      baseline == Baseline::radiance_cascades || baseline == Baseline::radiance_cascades_fine;
  if ((lights_by_rsm(baseline) || has_probes(baseline) || has_cascades) && bounces != 1)
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
  if (baseline == Baseline::paths_filtered) cell.settings["filter_passes"] = kPasses;
  if (baseline == Baseline::vpl_interleaved) cell.settings["filter_passes"] = 1;
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
