// SPDX-License-Identifier: MIT
// Path tracing in a scene: the truth that an image of the pipeline is held against, pixel by pixel.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <thread>

#include "pathtracer/path_sampler.hpp"
#include "pathtracer/ray_scene.hpp"
#include "pathtracer/sampling.hpp"
#include "pathtracer/sky_sampler.hpp"
#include "reference/view.hpp"
#include "scene/emission.hpp"
#include "scene/light_kind.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"

namespace clpv::reference {
namespace {

constexpr std::uint32_t kTile = 16;          // pixels along each side of what a thread takes at a time
constexpr std::uint32_t kFirstSamples = 64;  // paths a pixel before the noise is judged at all
constexpr std::uint32_t kMostSamples = PathTracerOptions::kMostSamples;

/// A pixel's surface, and the two independent halves of its estimate.
struct Pixel {
  std::optional<Hit> hit;
  glm::dvec3 sum[2] = {glm::dvec3(0), glm::dvec3(0)};  // irradiance [W/m^2], summed over paths
};

/// Where a pixel looks.
glm::dvec3 direction_of(const ClpvView& view, std::uint32_t px, std::uint32_t py) {
  return glm::normalize(surface_position(view, px, py, 1) - surface_position(view, px, py, 0));
}

/// The image while it is traced, tile by tile.
class Work {
 public:
  Work(const Scene& scene, const std::vector<Light>& lights, const ClpvView& view,
       const PathTracerOptions& options, const TraceProgress& progress)
      : rays_(scene),
        emitters_(scene, rays_.materials()),
        sky_(scene.sky.get()),
        lights_(lights),
        options_(options),
        progress_(progress),
        pixels_(std::size_t{view.width} * view.height) {
    image_.view = view;
    image_.sky = scene.sky != nullptr;
    threads_ = options.threads > 0 ? options.threads : std::max(1u, std::thread::hardware_concurrency());
  }

  /// Everything that needs one ray a pixel: what is seen, and its direct light.
  void look() {
    image_.depth.assign(pixels_.size(), 0);
    for (auto* layer :
         {&image_.normal, &image_.albedo, &image_.emissive, &image_.direct, &image_.irradiance}) {
      layer->assign(pixels_.size(), glm::vec3(0));
    }
    each_pixel([&](PathSampler& sampler, std::uint32_t x, std::uint32_t y) {
      const std::size_t i = std::size_t{y} * image_.view.width + x;
      pixels_[i].hit = sampler.see(image_.view, x, y);
      if (!pixels_[i].hit) {
        if (image_.sky) image_.emissive[i] = sky_.seen(direction_of(image_.view, x, y));
        return;
      }
      const Hit& hit = *pixels_[i].hit;
      image_.depth[i] = hit.distance;
      image_.normal[i] = hit.normal;
      const Footprint around = footprint(image_.view, x, y, hit);
      image_.albedo[i] = rays_.materials().albedo(hit.point, around);
      image_.emissive[i] = rays_.materials().emissive(hit.point, around);
      image_.direct[i] = glm::vec3(sampler.direct(hit));
    });
  }

  /// Paths until there are `samples` a pixel, half of them in each half (the first takes an odd one).
  void trace(std::uint32_t samples) {
    each_pixel([&](PathSampler& sampler, std::uint32_t x, std::uint32_t y) {
      const std::size_t i = std::size_t{y} * image_.view.width + x;
      Pixel& pixel = pixels_[i];
      if (!pixel.hit) return;
      for (std::uint32_t half = 0; half < 2; ++half) {
        const std::uint64_t stream = mix(mix(options_.seed), 2 * i + half);
        for (std::uint32_t s = share(image_.samples, half); s < share(samples, half); ++s) {
          pixel.sum[half] += sampler.indirect(*pixel.hit, s, stream);
        }
      }
    });
    image_.samples = samples;
    image_.noise = noise();
  }

  TracedImage finish() {
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      image_.irradiance[i] = glm::vec3((pixels_[i].sum[0] + pixels_[i].sum[1]) / double(image_.samples));
    }
    return std::move(image_);
  }

  double current_noise() const { return image_.noise; }
  void expect(double share_before, double share_after) { before_ = share_before, after_ = share_after; }

 private:
  static std::uint32_t share(std::uint32_t samples, std::uint32_t half) { return (samples + 1 - half) / 2; }

  /// Runs action(sampler, x, y) once a pixel, tiles handed to threads as they come.
  template <typename Action>
  void each_pixel(const Action& action) {
    const std::uint32_t width = image_.view.width, height = image_.view.height;
    const std::uint32_t columns = (width + kTile - 1) / kTile,
                        tiles = columns * ((height + kTile - 1) / kTile);
    std::atomic<std::uint32_t> next{0};
    std::uint32_t done = 0;
    std::mutex mutex;
    const auto run = [&] {
      PathSampler sampler(rays_, lights_, emitters_, sky_, options_);
      for (std::uint32_t tile; !interrupted() && (tile = next.fetch_add(1)) < tiles;) {
        const std::uint32_t left = tile % columns * kTile, top = tile / columns * kTile;
        for (std::uint32_t y = top; y < std::min(top + kTile, height); ++y) {
          for (std::uint32_t x = left; x < std::min(left + kTile, width); ++x) action(sampler, x, y);
        }
        const std::lock_guard lock(mutex);
        ++done;
        if (progress_) progress_(before_ + (after_ - before_) * done / tiles);
      }
      const std::lock_guard lock(mutex);
      image_.rays += sampler.rays_shot();
    };
    {
      std::vector<std::jthread> others;
      for (int t = 1; t < threads_; ++t) others.emplace_back(run);
      run();
    }
    stop_if_interrupted();
  }

  /// TracedImage::noise of the paths so far. The halves differ by twice the error of their mean, in the mean
  /// square.
  double noise() const {
    const std::uint32_t counts[2] = {share(image_.samples, 0), share(image_.samples, 1)};
    if (counts[1] == 0) return std::numeric_limits<double>::quiet_NaN();
    double error = 0, signal = 0;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      const glm::dvec3 a = pixels_[i].sum[0] / double(counts[0]), b = pixels_[i].sum[1] / double(counts[1]);
      const glm::dvec3 albedo(image_.albedo[i]);
      const glm::dvec3 mean = albedo * (a + b) / 2.0, spread = albedo * (a - b) / 2.0;
      error += glm::dot(spread, spread);
      signal += glm::dot(mean, mean);
    }
    return signal > 0 ? std::sqrt(error / signal) : 0.0;
  }

  RayScene rays_;
  Emitters emitters_;
  SkySampler sky_;
  const std::vector<Light>& lights_;
  const PathTracerOptions& options_;
  const TraceProgress& progress_;
  std::vector<Pixel> pixels_;
  TracedImage image_;
  int threads_ = 1;
  double before_ = 0, after_ = 0;
};

void check(const Scene& scene, const std::vector<Light>& lights, const PathTracerOptions& options) {
  if (options.bounces < 0) throw Error(ExitCode::usage, "bounces {}: 1 or more, or all", options.bounces);
  if (options.samples > kMostSamples) {
    throw Error(ExitCode::usage, "{} samples a pixel: at most {}", options.samples, kMostSamples);
  }
  if (options.samples == 0 && !(options.noise > 0))
    throw Error(ExitCode::usage, "noise {}: above 0", options.noise);
  if (lights.empty() && !emits(scene) && !scene.sky) {
    throw Error(ExitCode::bad_input, "{}: no light: the whole image would be black", scene.path);
  }
  for (const Light& light : lights) {
    const ClpvLight& d = light.data;
    const auto finite = [](const float(&v)[3]) { return std::isfinite(v[0] + v[1] + v[2]); };
    kind_of(d);  // throws for what is none
    if (!finite(d.position) || !finite(d.direction) || !finite(d.intensity) ||
        !std::isfinite(d.range + d.cone_scale + d.cone_offset)) {
      throw Error(ExitCode::bad_input, "{}: light {}: a value that is not finite", scene.path, light.name);
    }
  }
}

/// The next count of paths: powers of two and the sums of two neighbouring ones, where Sobol points are most
/// even.
std::uint32_t next_count(std::uint32_t samples) {
  const bool power = (samples & (samples - 1)) == 0;
  return power ? samples + samples / 2 : samples / 3 * 4;
}

/// How many paths reach the target, if the error falls with n^(-3/4) as it does between scrambled Sobol
/// points.
double expected_count(std::uint32_t samples, double noise, double target) {
  return samples * std::pow(std::max(1.0, noise / target), 4.0 / 3.0);
}

}  // namespace

TracedImage trace_paths(const Scene& scene, const std::vector<Light>& lights, const ClpvView& view,
                        const PathTracerOptions& options, const TraceProgress& progress) {
  check(scene, lights, options);
  Work work(scene, lights, view, options, progress);
  work.look();
  if (options.samples > 0) {
    work.expect(0, 1);
    work.trace(options.samples);
    return work.finish();
  }
  std::uint32_t done = 0;
  for (std::uint32_t count = kFirstSamples; count <= kMostSamples; count = next_count(count)) {
    const double goal =
        done == 0 ? count
                  : std::max<double>(count, expected_count(done, work.current_noise(), options.noise));
    work.expect(done / goal, count / goal);
    work.trace(count);
    done = count;
    if (work.current_noise() <= options.noise) break;
  }
  return work.finish();
}

}  // namespace clpv::reference
