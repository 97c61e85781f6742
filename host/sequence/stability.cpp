// SPDX-License-Identifier: MIT
#include "sequence/stability.hpp"

#include <algorithm>
#include <cmath>

#include "pathtracer/path_tracer.hpp"
#include "reference/view.hpp"
#include "support/fingerprint.hpp"

namespace clpv {
namespace {

// Maximum angle between normals of adjacent pixels on one surface, smooth ones included: 8 degrees.
constexpr double kMinCosine = 0.99;
// Maximum distance of a point from the nearest pixel's plane, in pixel edges; curved surfaces
// deviate by less.
constexpr double kOffPlane = 0.1;
// Maximum distance along the surface: half a pixel's diagonal across the view, more on slanted
// surfaces.
constexpr double kApart = 0.75;

glm::dvec3 normal_of(const SurfaceImage& image, std::size_t pixel) {
  return glm::dvec3(image.normal[pixel]);
}

/// Returns the pixel of `later` that shows a point, or kNotSeen.
std::size_t pixel_of(const SurfaceImage& later, const glm::dvec3& point, const glm::dvec3& normal) {
  const reference::ProjectedPoint at = reference::project(later.view, point);
  if (!(at.depth > later.view.near_depth)) return kNotSeen;
  const double x = std::round(at.pixel.x), y = std::round(at.pixel.y);
  if (!(x >= 0 && x < later.view.width && y >= 0 && y < later.view.height)) return kNotSeen;
  const std::size_t pixel =
      static_cast<std::size_t>(y) * later.view.width + static_cast<std::size_t>(x);
  if (later.depth[pixel] <= 0) return kNotSeen;
  const glm::dvec3 there =
                       reference::surface_position(later.view, x, y, double{later.depth[pixel]}),
                   off = there - point, there_normal = normal_of(later, pixel);
  const double edge = reference::pixel_edge(later.view, at.depth);
  const glm::dvec3 ray = glm::normalize(there - vector(later.view.eye));
  const double slope = std::max(std::abs(glm::dot(ray, there_normal)), 0.05);
  const bool same = glm::dot(normal, there_normal) > kMinCosine &&
                    std::abs(glm::dot(off, normal)) < kOffPlane * edge &&
                    glm::length(off) * slope < kApart * edge;
  return same ? pixel : kNotSeen;
}

}  // namespace

std::vector<std::size_t> later_pixels(const SurfaceImage& earlier, const SurfaceImage& later) {
  std::vector<std::size_t> pixels(earlier.depth.size(), kNotSeen);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (earlier.depth[i] <= 0) continue;
    const auto x = static_cast<double>(i % earlier.view.width),
               y = static_cast<double>(i / earlier.view.width);
    pixels[i] =
        pixel_of(later, reference::surface_position(earlier.view, x, y, double{earlier.depth[i]}),
                 normal_of(earlier, i));
  }
  return pixels;
}

std::vector<bool> still_seen(const SurfaceImage& earlier, const SurfaceImage& later) {
  const std::vector<std::size_t> pixels = later_pixels(earlier, later);
  std::vector<bool> seen(pixels.size());
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = pixels[i] != kNotSeen;
  return seen;
}

LightChange change_of_light(const std::vector<bool>& counted, const std::vector<float>& before,
                            const std::vector<float>& after) {
  std::vector<double> changes;
  double light = 0, change = 0;
  for (std::size_t i = 0; i < counted.size(); ++i) {
    if (!counted[i]) continue;
    double here = 0;
    for (std::size_t c = 4 * i; c < 4 * i + 3; ++c) {
      light += double{before[c]};
      here += std::abs(double{after[c]} - double{before[c]});
    }
    change += here;
    changes.push_back(here);
  }
  LightChange found{changes.size(), {}, {}};
  if (!(light > 0)) return found;
  found.mean = change / light;
  const auto nth =
      changes.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(changes.size() - 1));
  std::nth_element(changes.begin(), nth, changes.end());
  found.p95 = *nth * static_cast<double>(changes.size()) / light;
  return found;
}

namespace {

std::uint64_t content_of(const SceneData& scene, const SceneCamera& camera) {
  Fingerprint print;
  add_moving(print, scene);
  for (const SceneLight& light : scene.lights_for(camera)) print.add(std::vector{light.data});
  return print.value();
}

std::vector<int> moved(const std::vector<ClpvGrid>& before, const std::vector<ClpvGrid>& now) {
  std::vector<int> cascades;
  for (std::size_t c = 0; c < now.size(); ++c) {
    if (!std::equal(now[c].origin, now[c].origin + 3, before[c].origin))
      cascades.push_back(static_cast<int>(c));
  }
  return cascades;
}

}  // namespace

void Stability::add(int number, double seconds, const SceneData& scene, const SceneCamera& camera) {
  Seen now{read_surface(session_, frame_.seen()), frame_.read(Show::irradiance),
           frame_.light().grids, content_of(scene, camera)};
  if (before_) {
    const std::vector<bool> counted = still_seen(before_->surfaces, now.surfaces);
    const auto surfaces =
        std::ranges::count_if(before_->surfaces.depth, [](float d) { return d > 0; });
    const LightChange change = change_of_light(counted, before_->irradiance, light_before(now));
    const double seen =
        surfaces > 0 ? static_cast<double>(change.points) / static_cast<double>(surfaces) : 0.0;
    steps_.push_back({number, seconds, now.content == before_->content,
                      moved(before_->grids, now.grids), seen, change,
                      noise(scene, camera, counted)});
  }
  before_ = std::move(now);
}

/// Light of the frame `now` at the points of the previous one: from the volumes, with the
/// near-field correction of the nearest pixels.
std::vector<float> Stability::light_before(const Seen& now) {
  std::vector<float> light = frame_.irradiance_on(before_->surfaces);
  if (!frame_.options().traces_near()) return light;
  const std::vector<float> volumes = frame_.irradiance_on(now.surfaces);
  const std::vector<std::size_t> pixels = later_pixels(before_->surfaces, now.surfaces);
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (pixels[i / 4] == kNotSeen) continue;
    const std::size_t there = 4 * pixels[i / 4] + i % 4;
    light[i] += now.irradiance[there] - volumes[there];
  }
  return light;
}

/// Compares two path-traced images of the previous frame's surfaces under the current light.
std::optional<double> Stability::noise(const SceneData& scene, const SceneCamera& camera,
                                       const std::vector<bool>& counted) const {
  if (traced_ == 0) return {};
  const auto traced = [&](std::uint64_t seed) {
    pathtracer::PathTracerOptions options;
    options.samples = traced_, options.seed = seed;
    const auto image =
        pathtracer::trace_paths(scene, scene.lights_for(camera), before_->surfaces.view, options);
    std::vector<float> values;
    for (const glm::vec3& e : image.irradiance) values.insert(values.end(), {e.x, e.y, e.z, 0});
    return values;
  };
  return change_of_light(counted, traced(1), traced(2)).mean;
}

}  // namespace clpv
