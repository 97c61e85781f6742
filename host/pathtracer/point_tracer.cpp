// SPDX-License-Identifier: MIT
// Paths of a point are in independent streams, whose means differ by the error of their mean.
#include "pathtracer/point_tracer.hpp"

#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>

#include "basis/sampling.hpp"
#include "pathtracer/path_sampler.hpp"
#include "pathtracer/tracing.hpp"
#include "scene/emission.hpp"
#include "support/interrupt.hpp"

namespace clpv::pathtracer {
namespace {

constexpr std::uint32_t kStreams = 8;
constexpr double kSurfaceDistance = 1e-5;  // share of the scene's largest edge
constexpr double kTangential = 1e-3;       // cosine of a surface's normal and the given one
constexpr double kProbeWeight = 4;         // 1 / (Vertex::Kind::probe's factor)
constexpr int kSurroundingRays = 128;
constexpr int kNearRays = 32;       // one within 30 degrees of each direction
constexpr double kNearReach = 2;    // their length, in distances from a surface
constexpr std::size_t kBatch = 16;  // points that a thread takes at a time
constexpr std::uint64_t kPointSeed = 0x706f696e74;

/// Directions that cover the sphere evenly, the first ones too.
glm::vec3 surrounding(int ray) {
  return glm::vec3(phase_direction(glm::dvec3(0, 0, 1), 0,
                                   sobol_point(static_cast<std::uint32_t>(ray), kPointSeed)));
}

glm::dvec3 to_origin(const SceneData& scene) {
  const auto [lower, upper] = bounds_of(scene.vertices);
  return -(glm::dvec3(lower) + glm::dvec3(upper)) / 2.0;
}

std::uint32_t of_stream(std::uint32_t samples, std::uint32_t stream) {
  return (samples + kStreams - 1 - stream) / kStreams;
}

}  // namespace

struct PointTracer::Impl {
  glm::dvec3 by;  // added to positions
  CentredScene centred;
  PathTracerOptions options;
  RayScene rays;
  Emitters emitters;
  SkySampler sky;
  double near_surface;
  int threads;
  std::mutex mutex;
  std::uint64_t ray_count = 0;

  Impl(const SceneData& scene, const std::vector<SceneLight>& lights,
       const PathTracerOptions& given)
      : by(to_origin(scene)),
        centred(scene, lights, by),
        options(given),
        rays(centred.scene),
        emitters(centred.scene, rays.materials()),
        sky(centred.scene.sky.get()),
        threads(given.threads > 0 ? given.threads : single_rank().processors()) {
    const auto [lower, upper] = bounds_of(scene.vertices);
    const glm::dvec3 edges = glm::dvec3(upper) - glm::dvec3(lower);
    near_surface = kSurfaceDistance * std::max({edges.x, edges.y, edges.z});
  }

  glm::vec3 place(const glm::dvec3& position) const { return glm::vec3(position + by); }

  /// The place of a probe: not on a surface, but at its front.
  glm::vec3 probe_place(const glm::dvec3& position) const {
    const glm::dvec3 at = position + by;
    return glm::vec3(at + rays.way_off_surfaces(at, glm::dvec3(0), near_surface));
  }

  /// Whether a ray hits the back of a wall: double-sided surfaces are no walls.
  bool back(std::uint32_t triangle, const glm::vec3& direction) const {
    const SceneData& scene = centred.scene;
    return !double_sided(scene.materials[scene.triangles[triangle].material]) &&
           glm::dot(emitters.front_normal(triangle), glm::dvec3(direction)) > 0;
  }

  /// Calls action(sampler, i) for i below `count`, on all threads.
  template <typename Action>
  void parallel_for(std::size_t count, const Action& action) {
    std::atomic<std::size_t> next{0};
    on_threads(threads, [&, stop = current_stop()](const std::atomic<bool>& failed) {
      const StopScope scope(stop);
      PathSampler sampler(rays, centred.lights, emitters, sky,
                          centred.scene.medium ? &*centred.scene.medium : nullptr, options);
      for (std::size_t first;
           !failed && !interrupted() && (first = next.fetch_add(kBatch)) < count;)
        for (std::size_t i = first; i < std::min(first + kBatch, count); ++i) action(sampler, i);
      const std::lock_guard lock(mutex);
      ray_count += sampler.ray_count();
    });
    stop_if_interrupted();
  }

  PathSampler::Vertex vertex_of(const SurfacePoint& point) const {
    PathSampler::Vertex vertex;
    const glm::dvec3 place = point.position + by,
                     way = rays.way_off_surfaces(place, point.normal, near_surface);
    const glm::vec3 at(place), normal(point.normal);
    const auto lift = static_cast<float>(near_surface);
    if (const auto hit = rays.intersect(at + lift * normal, -normal, 0, 2 * lift, Faces::all)) {
      const glm::dvec3 geometric(hit->geometric);
      if (glm::dot(geometric, point.normal) > kTangential) {
        vertex.hit = *hit;
        vertex.hit.normal = normal;
        // Off other surfaces that meet here.
        vertex.hit.position =
            glm::vec3(glm::dvec3(hit->position) + way - glm::dot(way, geometric) * geometric);
        return vertex;
      }
    }
    vertex.kind = PathSampler::Vertex::Kind::element;
    vertex.hit.position = glm::vec3(place + way), vertex.hit.geometric = vertex.hit.normal = normal;
    return vertex;
  }

  /// Sums of integrals over the paths of vertices.
  struct Sums {
    std::vector<PathSampler::Vertex> vertices;
    Moments moments;
    double weight;
    std::uint64_t first;           // number of the first vertex
    std::vector<glm::dvec3> sums;  // [vertex][stream][integral]
    std::uint32_t samples = 0;
    double level = 0, noise = 0;

    void clear() { sums.assign(vertices.size() * kStreams * moments.count, glm::dvec3(0)); }
    glm::dvec3& at(std::size_t vertex, std::size_t stream, std::size_t i) {
      return sums[(vertex * kStreams + stream) * moments.count + i];
    }
  };

  Sums sums_of(std::span<const glm::dvec3> positions, const Moments& moments,
               std::uint64_t first) const {
    Sums s{{}, moments, kProbeWeight, first, {}};
    for (const glm::dvec3& position : positions) {
      PathSampler::Vertex& vertex = s.vertices.emplace_back();
      vertex.kind = PathSampler::Vertex::Kind::probe;
      vertex.hit.position = probe_place(position);
    }
    return s;
  }

  void trace(Sums& s, std::uint32_t samples, const std::function<void(double)>& done) {
    std::size_t finished = 0;
    parallel_for(s.vertices.size(), [&](PathSampler& sampler, std::size_t i) {
      std::vector<double> g(s.moments.count, 1.0);
      for (std::uint32_t k = 0; k < kStreams; ++k) {
        const std::uint64_t stream =
            mix(mix(mix(options.seed), kPointSeed), (s.first + i) * kStreams + k);
        for (std::uint32_t path = of_stream(s.samples, k);
             path < of_stream(samples, k) && !interrupted(); ++path) {
          for (const Arrival& arrival : sampler.arriving(s.vertices[i], path, stream)) {
            if (arrival.light == glm::dvec3(0)) continue;
            if (s.moments.weights) s.moments.weights(arrival.direction, g);
            for (std::size_t m = 0; m < g.size(); ++m)
              s.at(i, k, m) += s.weight * g[m] * arrival.light;
          }
        }
      }
      const std::lock_guard lock(mutex);
      done(static_cast<double>(++finished) / static_cast<double>(s.vertices.size()));
    });
    s.samples = samples;
  }

  static glm::dvec3 mean(Sums& s, std::size_t vertex, std::size_t i) {
    glm::dvec3 sum(0);
    for (std::size_t k = 0; k < kStreams; ++k) sum += s.at(vertex, k, i);
    return sum / double(s.samples);
  }

  /// Standard error of mean(): from the deviations of the streams' means.
  static glm::dvec3 error(Sums& s, std::size_t vertex, std::size_t i) {
    const std::uint32_t streams = std::min(s.samples, kStreams);
    if (streams < 2) return glm::dvec3(std::numeric_limits<double>::quiet_NaN());
    const glm::dvec3 middle = mean(s, vertex, i);
    glm::dvec3 squares(0);
    for (std::uint32_t k = 0; k < streams; ++k) {
      const glm::dvec3 off = s.at(vertex, k, i) / double(of_stream(s.samples, k)) - middle;
      squares += off * off;
    }
    return glm::sqrt(squares / double(streams * (streams - 1)));
  }

  /// Sets the noise relative to `level`, or to the root mean square of these vertices.
  static void estimate(Sums& s, double level) {
    double errors = 0, values = 0;
    const std::size_t numbers = s.vertices.size() * s.moments.count;
    for (std::size_t n = 0; n < numbers; ++n) {
      const std::size_t vertex = n / s.moments.count, i = n % s.moments.count;
      const glm::dvec3 e = error(s, vertex, i), m = mean(s, vertex, i);
      errors += glm::dot(e, e), values += glm::dot(m, m);
    }
    if (!std::isfinite(values))
      throw Error(
          ExitCode::run_time,
          "path-traced light: found {} among {} numbers, allowed: finite ones, whose squares "
          "are too",
          values, numbers);
    const auto count = static_cast<double>(std::max<std::size_t>(3 * numbers, 1));
    s.level = level > 0 ? level : std::sqrt(values / count);
    s.noise = s.level > 0 ? std::sqrt(errors / count) / s.level : 0;
  }

  /// Adds paths until the noise is reached, or as many as the options say.
  void trace_all(Sums& s, double level, const TraceProgress& progress) {
    s.clear();
    double reported = 0;
    const auto report = [&](double share) {
      if (progress) progress(reported = std::max(reported, share));
    };
    const bool fixed = options.samples > 0;
    double goal = fixed ? options.samples : kFirstSamples;
    for (std::uint32_t count = fixed ? options.samples : kFirstSamples;
         count <= PathTracerOptions::kMaxSamples; count = next_count(count)) {
      goal = std::max<double>(goal, count);
      const std::uint32_t before = s.samples;
      trace(s, count, [&](double share) {
        if (fixed || before > 0) report((before + share * (count - before)) / goal);
      });
      estimate(s, level);
      if (fixed || s.noise <= options.noise) break;
      goal = expected_count(count, s.noise, options.noise);
    }
    report(1);
  }

  std::uint64_t take_rays() { return std::exchange(ray_count, 0); }
};

PointTracer::PointTracer(const SceneData& scene, const std::vector<SceneLight>& lights,
                         const PathTracerOptions& options) {
  check(options);
  impl_ = std::make_unique<Impl>(scene, lights, options);
}

PointTracer::~PointTracer() = default;

double PointTracer::surface_distance() const {
  return impl_->near_surface;
}

TracedPoints PointTracer::irradiance(std::span<const SurfacePoint> points,
                                     const TraceProgress& progress) {
  Impl::Sums s{{}, {1, {}}, 1, 0, {}};
  for (const SurfacePoint& point : points) s.vertices.push_back(impl_->vertex_of(point));
  impl_->trace_all(s, 0, progress);
  TracedPoints traced;
  traced.points.resize(points.size());
  impl_->parallel_for(points.size(), [&](PathSampler& sampler, std::size_t i) {
    traced.points[i] = {sampler.direct(s.vertices[i]), Impl::mean(s, i, 0), Impl::error(s, i, 0)};
  });
  traced.samples = s.samples, traced.noise = s.noise, traced.rays = impl_->take_rays();
  return traced;
}

TracedProbes PointTracer::probes(std::span<const glm::dvec3> positions, const Moments& moments,
                                 std::uint64_t first, double level, const TraceProgress& progress) {
  Impl::Sums s = impl_->sums_of(positions, moments, first);
  impl_->trace_all(s, level, progress);
  TracedProbes traced;
  const std::size_t n = moments.count;
  traced.indirect.resize(positions.size() * n), traced.error.resize(positions.size() * n);
  for (std::size_t k = 0; k < traced.indirect.size(); ++k) {
    traced.indirect[k] = Impl::mean(s, k / n, k % n);
    traced.error[k] = Impl::error(s, k / n, k % n);
  }
  traced.samples = s.samples, traced.noise = s.noise, traced.level = s.level;
  traced.rays = impl_->take_rays();
  return traced;
}

double PointTracer::level(std::span<const glm::dvec3> positions, const Moments& moments) {
  Impl::Sums s = impl_->sums_of(positions, moments, 0);
  s.clear();
  impl_->trace(s, kFirstSamples, [](double) {});
  Impl::estimate(s, 0);
  return s.level;
}

std::vector<glm::dvec3> PointTracer::direct(std::span<const glm::dvec3> positions,
                                            const Moments& moments) {
  const std::size_t n = moments.count;
  std::vector<glm::dvec3> all(positions.size() * n, glm::dvec3(0));
  impl_->parallel_for(positions.size(), [&](PathSampler& sampler, std::size_t i) {
    std::vector<double> g(n);
    for (const reference::Incident& in : sampler.lights_at(impl_->probe_place(positions[i]))) {
      moments.weights(in.towards, g);
      for (std::size_t m = 0; m < n; ++m) all[i * n + m] += g[m] * in.irradiance;
    }
  });
  return all;
}

std::vector<PointTracer::Surroundings> PointTracer::surroundings(
    std::span<const glm::dvec3> positions) {
  std::vector<Surroundings> all(positions.size());
  impl_->parallel_for(positions.size(), [&](PathSampler&, std::size_t i) {
    const glm::vec3 place = impl_->probe_place(positions[i]);
    for (int ray = 0; ray < kSurroundingRays; ++ray) {
      const glm::vec3 direction = surrounding(ray);
      const auto hit = impl_->rays.intersect(place, direction, 0,
                                             std::numeric_limits<float>::infinity(), Faces::all);
      const double share = 1.0 / kSurroundingRays;
      if (!hit) {
        all[i].open += share;
      } else if (impl_->back(hit->point.triangle, direction)) {
        all[i].backs += share;
      }
    }
  });
  return all;
}

std::vector<glm::dvec3> PointTracer::off_surfaces(std::span<const glm::dvec3> positions,
                                                  double distance) {
  std::vector<glm::dvec3> all(positions.begin(), positions.end());
  const auto reach = static_cast<float>(kNearReach * distance);
  impl_->parallel_for(positions.size(), [&](PathSampler&, std::size_t i) {
    const glm::vec3 place = impl_->probe_place(positions[i]);
    glm::dvec3 way(0);
    for (int ray = 0; ray < kNearRays; ++ray) {
      const auto hit = impl_->rays.intersect(place, surrounding(ray), 0, reach, Faces::all);
      if (!hit) continue;
      const glm::dvec3 normal(hit->geometric),
          from_surface = glm::dvec3(place) + way - glm::dvec3(hit->position);
      way += std::max(0.0, distance - glm::dot(from_surface, normal)) * normal;
    }
    if (way == glm::dvec3(0)) return;
    const auto opposite = impl_->rays.intersect(place, glm::vec3(way), 0, 2, Faces::all);
    const double share = opposite ? std::min(1.0, double{opposite->distance} / 2) : 1;
    all[i] = glm::dvec3(place) + share * way - impl_->by;
  });
  return all;
}

bool PointTracer::hit(const glm::dvec3& origin, const glm::dvec3& direction, SurfacePoint& found) {
  const auto hit = impl_->rays.intersect(impl_->place(origin), glm::vec3(direction), 0,
                                         std::numeric_limits<float>::infinity(), Faces::all);
  if (!hit) return false;
  found = {glm::dvec3(hit->position) - impl_->by, glm::dvec3(hit->geometric)};
  return true;
}

}  // namespace clpv::pathtracer
