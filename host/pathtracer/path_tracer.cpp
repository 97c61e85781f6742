// SPDX-License-Identifier: MIT
// Path tracer: distributes tiles over threads and ranks, and adds paths until the noise is reached.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <optional>
#include <utility>

#include "basis/sampling.hpp"
#include "pathtracer/emitters.hpp"
#include "pathtracer/path_sampler.hpp"
#include "pathtracer/ray_scene.hpp"
#include "pathtracer/tracing.hpp"
#include "reference/view.hpp"
#include "scene/emission.hpp"
#include "scene/scene.hpp"
#include "support/error.hpp"
#include "support/interrupt.hpp"

namespace clpv::pathtracer {
namespace {

constexpr std::uint32_t kTile = 16;  // edge of a tile [pixels], the unit of work of a thread
// Paths per pixel before the first estimate of the noise, which only the progress uses.
constexpr std::uint32_t kFirstEstimate = 16;
// Progress until the noise is reached: an estimate that is too low must not report completion.
constexpr double kAlmostDone = 0.99;

/// Unit direction of the ray through a pixel's centre.
glm::dvec3 direction_of(const ClpvView& view, std::uint32_t px, std::uint32_t py) {
  return glm::normalize(reference::surface_position(view, px, py, 1) -
                        reference::surface_position(view, px, py, 0));
}

/// The part of a pixel's ray that the camera sees.
struct PrimaryRay {
  glm::dvec3 origin, direction;  ///< unit
  double length;                 ///< [m] infinite without a surface
};

/// `depth`: of the pixel's surface, 0 without one.
PrimaryRay primary_ray(const ClpvView& view, std::size_t pixel, float depth) {
  const auto x = static_cast<std::uint32_t>(pixel % view.width),
             y = static_cast<std::uint32_t>(pixel / view.width);
  const glm::dvec3 origin = reference::surface_position(view, x, y, 0),
                   at_unit_depth = reference::surface_position(view, x, y, 1);
  const double length = glm::length(at_unit_depth - origin);
  return {origin, (at_unit_depth - origin) / length,
          depth > 0 ? length * depth : std::numeric_limits<double>::infinity()};
}

/// Transmittance of the medium between the camera and what it sees in a pixel.
glm::vec3 seen_through(const TracedImage& traced, std::size_t pixel) {
  if (!traced.medium) return glm::vec3(1);
  const PrimaryRay ray = primary_ray(traced.view, pixel, traced.depth[pixel]);
  return glm::vec3(transmittance(
      *traced.medium, medium_part(*traced.medium, ray.origin, ray.direction, ray.length)));
}

/// Traces one image, tile by tile.
class ImageTracer {
 public:
  ImageTracer(const SceneData& scene, const std::vector<SceneLight>& lights, const ClpvView& view,
              const PathTracerOptions& options, const TraceProgress& progress, Ranks& ranks)
      : rays_(scene),
        emitters_(scene, rays_.materials()),
        sky_(scene.sky.get()),
        lights_(lights),
        options_(options),
        progress_(progress),
        ranks_(ranks),
        hits_(std::size_t{view.width} * view.height),
        layers_(scene.medium ? 2 : 1),
        rank_sums_(2 * layers_ * hits_.size(), glm::dvec3(0)) {
    image_.view = view;
    image_.sky = scene.sky != nullptr;
    image_.medium = scene.medium;
    threads_ = options.threads > 0 ? options.threads : ranks.processors();
  }

  /// Traces primary rays and computes direct light, one pixel at a time. Every rank does so for the
  /// whole image.
  void trace_primary_rays() {
    image_.depth.assign(hits_.size(), 0);
    for (auto* layer : {&image_.normal, &image_.albedo, &image_.emissive, &image_.direct,
                        &image_.irradiance, &image_.scattered}) {
      layer->assign(hits_.size(), glm::vec3(0));
    }
    parallel_for({0, 1, tiles()}, [&](PathSampler& sampler, std::size_t tile) {
      for_each_pixel(tile, [&](std::size_t i, std::uint32_t x, std::uint32_t y) {
        trace_primary_ray(sampler, i, x, y);
      });
    });
    if (!ranks_.is_root()) image_.rays = 0;  // finish() sums the counts of all ranks
  }

  /// Adds paths up to `samples` per pixel. The two halves get equal numbers; the first gets an odd
  /// path.
  void trace(std::uint32_t samples) {
    const auto rank = static_cast<std::size_t>(ranks_.rank()),
               count = static_cast<std::size_t>(ranks_.size());
    const Items items{rank, count, 2 * std::size_t{tiles()}};
    std::size_t done = 0;
    parallel_for(items, [&](PathSampler& sampler, std::size_t item) {
      const auto half = static_cast<std::uint32_t>(item % 2);
      for_each_pixel(item / 2, [&](std::size_t i, std::uint32_t, std::uint32_t) {
        const std::uint64_t stream = mix(mix(options_.seed), 2 * i + half);
        const auto add = [&](std::size_t pixel, const auto& path_of) {
          glm::dvec3 sum = rank_sums_[2 * pixel + half];
          for (std::uint32_t s = half_of(image_.samples, half);
               s < half_of(samples, half) && !interrupted(); ++s)
            sum += path_of(s);
          rank_sums_[2 * pixel + half] = sum;
        };
        if (hits_[i])
          add(i, [&](std::uint32_t s) { return sampler.indirect({*hits_[i]}, s, stream); });
        if (layers_ == 1) return;
        const PrimaryRay ray = primary_ray(image_.view, i, image_.depth[i]);
        add(hits_.size() + i, [&](std::uint32_t s) {
          return sampler.scattered_towards(ray.origin, ray.direction, ray.length, s, stream);
        });
      });
      const std::lock_guard lock(mutex_);
      done += count;
      report(progress_start_ + (progress_end_ - progress_start_) *
                                   std::min(1.0, static_cast<double>(done) / items.end));
    });
    sums_ = rank_sums_;  // one rank has each sum; the others add 0
    ranks_.sum({&sums_[0].x, 3 * sums_.size()});
    image_.samples = samples;
    image_.noise = noise();
  }

  TracedImage finish() {
    report(1);
    for (std::size_t i = 0; i < layers_ * hits_.size(); ++i)
      layer_number(image_, i) =
          glm::vec3((sums_[2 * i] + sums_[2 * i + 1]) / double(image_.samples));
    auto rays = static_cast<double>(image_.rays);
    ranks_.sum({&rays, 1});
    image_.rays = static_cast<std::uint64_t>(rays);
    return std::move(image_);
  }

  double current_noise() const { return image_.noise; }
  /// Sets the range of progress that the next trace() reports; an empty range reports nothing.
  void set_progress_range(double start, double end) {
    progress_start_ = start, progress_end_ = end;
  }

 private:
  /// The range first, first + step, ... below end.
  struct Items {
    std::size_t first, step, end;
  };

  static std::uint32_t half_of(std::uint32_t samples, std::uint32_t half) {
    return (samples + 1 - half) / 2;
  }

  /// Reports progress, which never falls, though the expected number of paths may rise. Reports it
  /// while it rests, too: the time left rises then.
  void report(double share) {
    if (!progress_ || !ranks_.is_root()) return;
    reported_ = std::max(reported_, share);
    progress_(reported_);
  }

  std::uint32_t columns() const { return (image_.view.width + kTile - 1) / kTile; }
  std::uint32_t tiles() const { return columns() * ((image_.view.height + kTile - 1) / kTile); }

  /// Entry `i` of the sums: a pixel's irradiance, or after all of these its scattered radiance.
  glm::vec3& layer_number(TracedImage& image, std::size_t i) const {
    return i < hits_.size() ? image.irradiance[i] : image.scattered[i - hits_.size()];
  }

  void trace_primary_ray(PathSampler& sampler, std::size_t i, std::uint32_t x, std::uint32_t y) {
    hits_[i] = sampler.primary_hit(image_.view, x, y);
    if (!hits_[i]) {
      if (image_.sky) image_.emissive[i] = sky_.interpolated(direction_of(image_.view, x, y));
      return;
    }
    const Hit& hit = *hits_[i];
    image_.depth[i] = hit.distance;
    image_.normal[i] = hit.normal;
    const reference::Footprint pixel = footprint(image_.view, x, y, hit);
    image_.albedo[i] = rays_.materials().albedo(hit.point, pixel);
    image_.emissive[i] = rays_.materials().emissive(hit.point, pixel);
    image_.direct[i] = glm::vec3(sampler.direct({hit}));
  }

  /// Calls action(i, x, y) for each pixel of a tile.
  template <typename Action>
  void for_each_pixel(std::size_t tile, const Action& action) const {
    const std::uint32_t width = image_.view.width, height = image_.view.height;
    const auto left = static_cast<std::uint32_t>(tile % columns()) * kTile,
               top = static_cast<std::uint32_t>(tile / columns()) * kTile;
    for (std::uint32_t y = top; y < std::min(top + kTile, height); ++y) {
      for (std::uint32_t x = left; x < std::min(left + kTile, width); ++x)
        action(std::size_t{y} * width + x, x, y);
    }
  }

  /// Calls action(sampler, item) for each item, on all threads.
  template <typename Action>
  void parallel_for(const Items& items, const Action& action) {
    std::atomic<std::size_t> next{items.first};
    on_threads(threads_, [&, stop = current_stop()](const std::atomic<bool>& failed) {
      const StopScope scope(stop);
      PathSampler sampler(rays_, lights_, emitters_, sky_,
                          image_.medium ? &*image_.medium : nullptr, options_);
      for (std::size_t item;
           !failed && !interrupted() && (item = next.fetch_add(items.step)) < items.end;)
        action(sampler, item);
      const std::lock_guard lock(mutex_);
      image_.rays += sampler.ray_count();
    });
    stop_if_interrupted();
  }

  /// TracedImage::noise of the paths so far: half the difference of the two halves estimates the
  /// error of their mean.
  double noise() const {
    const std::uint32_t counts[2] = {half_of(image_.samples, 0), half_of(image_.samples, 1)};
    if (counts[1] == 0) return std::numeric_limits<double>::quiet_NaN();
    double most = 0;
    for (std::size_t layer = 0; layer < layers_; ++layer) {
      double error = 0, signal = 0;
      for (std::size_t i = 0; i < hits_.size(); ++i) {
        const std::size_t at = 2 * (layer * hits_.size() + i);
        const glm::dvec3 a = sums_[at] / double(counts[0]), b = sums_[at + 1] / double(counts[1]);
        const glm::dvec3 factor = layer == 0 ? glm::dvec3(image_.albedo[i]) : glm::dvec3(1);
        const glm::dvec3 mean = factor * (a + b) / 2.0, deviation = factor * (a - b) / 2.0;
        error += glm::dot(deviation, deviation);
        signal += glm::dot(mean, mean);
      }
      if (signal > 0) most = std::max(most, std::sqrt(error / signal));
    }
    return most;
  }

  RayScene rays_;
  Emitters emitters_;
  SkySampler sky_;
  const std::vector<SceneLight>& lights_;
  const PathTracerOptions& options_;
  const TraceProgress& progress_;
  Ranks& ranks_;
  std::vector<std::optional<Hit>> hits_;  // primary hits, one per pixel
  std::size_t layers_;                    // 2 with a medium
  // Irradiance [W/m^2], and with a medium scattered radiance [W/m^2/sr], summed over paths, of this
  // rank and of all ranks: two independent halves per pixel.
  std::vector<glm::dvec3> rank_sums_, sums_;
  TracedImage image_;
  std::mutex mutex_;
  int threads_ = 1;
  double progress_start_ = 0, progress_end_ = 0, reported_ = 0;
};

/// Rejects eyes so far from the coordinates' origin that floats do not resolve what is near them.
void require_resolved(const SceneData& scene, const ClpvView& view) {
  const float farthest =
      std::max({std::abs(view.eye[0]), std::abs(view.eye[1]), std::abs(view.eye[2])});
  const float spacing = std::nextafter(farthest, std::numeric_limits<float>::infinity()) - farthest;
  if (spacing <= view.near_depth) return;
  throw Error(ExitCode::bad_input,
              "{}: camera at {:.7g} {:.7g} {:.7g} m, where float coordinates are {:.4g} m apart; "
              "allowed: up to the near plane, {:.4g} m",
              scene.path, view.eye[0], view.eye[1], view.eye[2], spacing, view.near_depth);
}

void check(const SceneData& scene, const std::vector<SceneLight>& lights, const ClpvView& view,
           const PathTracerOptions& options) {
  require_resolved(scene, view);
  check(options);
  if (lights.empty() && !emits(scene) && !scene.sky)
    throw Error(ExitCode::bad_input, "{}: no light, no emissive surface and no sky", scene.path);
}

}  // namespace

TracedImage trace_paths(const SceneData& scene, const std::vector<SceneLight>& lights,
                        const ClpvView& view, const PathTracerOptions& options,
                        const TraceProgress& progress, Ranks& ranks) {
  check(scene, lights, view, options);
  const glm::dvec3 by = -vector(view.eye);
  const CentredScene centred(scene, lights, by);
  ClpvView centred_view = view;
  move(centred_view.eye, by);
  ImageTracer tracer(centred.scene, centred.lights, centred_view, options, progress, ranks);
  const auto finished = [&] {
    TracedImage image = tracer.finish();
    image.view = view, image.medium = scene.medium;
    return image;
  };
  tracer.trace_primary_rays();
  if (options.samples > 0) {
    tracer.set_progress_range(0, 1);
    tracer.trace(options.samples);
    return finished();
  }
  tracer.trace(kFirstEstimate);  // nothing is known before it, and nothing reported
  std::uint32_t done = kFirstEstimate;
  for (std::uint32_t count = kFirstSamples; count <= PathTracerOptions::kMaxSamples;
       count = next_count(count)) {
    const double goal =
        std::max<double>(count, expected_count(done, tracer.current_noise(), options.noise));
    tracer.set_progress_range(kAlmostDone * done / goal, kAlmostDone * count / goal);
    tracer.trace(count);
    done = count;
    if (tracer.current_noise() <= options.noise) break;
  }
  return finished();
}

namespace {

glm::vec3 shown(const TracedImage& t, std::size_t i, Show show) {
  const glm::vec3 reflectance = t.albedo[i] * std::numbers::inv_pi_v<float>;
  switch (show) {
    case Show::full:
      return seen_through(t, i) * (reflectance * (t.direct[i] + t.irradiance[i]) + t.emissive[i]) +
             t.scattered[i];
    case Show::direct:
      return reflectance * t.direct[i] + t.emissive[i];
    case Show::indirect:
      return reflectance * t.irradiance[i];
    case Show::irradiance:
      return t.irradiance[i];
    case Show::albedo:
      return t.albedo[i];
    case Show::normal:
      return t.normal[i];
    case Show::depth:
      return glm::vec3(t.depth[i]);
    case Show::medium:
      return t.scattered[i];
    case Show::cells:  // require_traceable()
      break;
  }
  return glm::vec3(0);
}

}  // namespace

Image traced_view(const TracedImage& traced, Show show) {
  Image image = make_image(static_cast<int>(traced.view.width),
                           static_cast<int>(traced.view.height), {"R", "G", "B", "A"});
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    const bool surface = traced.depth[i] > 0;
    const bool air = traced.medium && shows_medium(show);
    if (!surface && !air && !(traced.sky && shows_sky(show))) continue;
    const glm::vec3 colour = surface || air ? shown(traced, i, show) : traced.emissive[i];
    for (int c = 0; c < 3; ++c) image.pixels[4 * i + c] = colour[c];
    image.pixels[4 * i + 3] = 1;
  }
  return image;
}

}  // namespace clpv::pathtracer
