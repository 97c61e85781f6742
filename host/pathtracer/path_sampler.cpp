// SPDX-License-Identifier: MIT
// Paths with next event estimation. Emitters and sky are sampled directly with density p_light, and hit by
// cosine-distributed directions with density p_cosine. The balance heuristic weights both (Veach and Guibas, 'Optimally
// combining sampling techniques for Monte Carlo rendering', SIGGRAPH 1995): each estimate is f / (p_light + p_cosine).
#include "pathtracer/path_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "basis/sampling.hpp"
#include "reference/lighting.hpp"
#include "reference/view.hpp"
#include "scene/light_kind.hpp"

namespace clpv::reference {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint64_t kEmitterStream = 1, kSkyStream = 2;  // random streams apart from that of directions
constexpr int kCertainBounces = 3;                           // Russian roulette starts at this bounce
constexpr double kMaxSurvival = 0.95;                        // so that paths end between white walls

/// Russian roulette. Returns false to end the path; else divides the throughput by the probability of survival.
bool survives(glm::dvec3& throughput, int bounce, std::uint64_t bits) {
  const double largest = std::max({throughput.x, throughput.y, throughput.z});
  if (bounce < kCertainBounces) return largest > 0;
  const double survival = std::min(largest, kMaxSurvival);
  if (uniform(bits) >= survival) return false;
  throughput /= survival;
  return true;
}

}  // namespace

std::optional<Hit> PathSampler::primary_hit(const ClpvView& view, std::uint32_t px, std::uint32_t py) {
  ++ray_count_;
  const glm::dvec3 origin = surface_position(view, px, py, 0),
                   at_unit_depth = surface_position(view, px, py, 1);
  return rays_.intersect(glm::vec3(origin), glm::vec3(at_unit_depth - origin), view.near_depth,
                         view.far_depth, Faces::culled);
}

bool PathSampler::shadowed(const ClpvLight& light, const glm::vec3& origin, const glm::dvec3& towards) const {
  if (kind_of(light) == LightKind::directional) return rays_.occluded(origin, glm::vec3(towards), kInfinity);
  const glm::vec3 to_light = glm::vec3(light.position[0], light.position[1], light.position[2]) - origin;
  return rays_.occluded(origin, to_light, 1);
}

glm::dvec3 PathSampler::direct(const Hit& hit) {
  const glm::vec3 origin = rays_.offset_origin(hit);
  glm::dvec3 sum(0);
  for (const SceneLight& light : lights_) {
    const Incident in = light_at(light.data, glm::dvec3(hit.position));
    const double cosine = glm::dot(glm::dvec3(hit.normal), in.towards);
    if (cosine <= 0 || glm::dot(glm::dvec3(hit.geometric), in.towards) <= 0) continue;
    if (in.irradiance == glm::dvec3(0)) continue;
    ++ray_count_;
    if (!shadowed(light.data, origin, in.towards)) sum += in.irradiance * cosine;
  }
  return sum;
}

/// Irradiance at `at` from a sampled emitter: L cos cos' / d^2 / (p_light + p_cosine), with densities over area.
glm::dvec3 PathSampler::sample_emitter(const Hit& at, const glm::dvec2& random) {
  const EmitterSample light = emitters_.sample(random);
  const glm::dvec3 to_light = glm::dvec3(light.position) - glm::dvec3(at.position);
  const double square = glm::dot(to_light, to_light);
  if (!(square > 0)) return glm::dvec3(0);
  const glm::dvec3 direction = to_light / std::sqrt(square),
                   front = emitters_.front_normal(light.point.triangle);
  const double cosine = glm::dot(glm::dvec3(at.normal), direction), light_cosine = glm::dot(front, direction);
  if (cosine <= 0 || glm::dot(glm::dvec3(at.geometric), direction) <= 0 || light_cosine == 0)
    return glm::dvec3(0);
  const glm::dvec3 radiance = emitters_.radiance(light.point, -direction);
  if (radiance == glm::dvec3(0) || rays_.materials().hole(light.point)) return glm::dvec3(0);
  Hit end;
  end.position = light.position, end.geometric = glm::vec3(light_cosine < 0 ? front : -front);
  const glm::vec3 origin = rays_.offset_origin(at);
  ++ray_count_;
  if (rays_.occluded(origin, rays_.offset_origin(end) - origin, 1)) return glm::dvec3(0);
  const double factor = cosine * std::abs(light_cosine) / square;
  return radiance * factor / (light.density + factor / std::numbers::pi);
}

/// Irradiance at `at` from the emissive surface `next` that a cosine-distributed direction hits: pi L p_cosine /
/// (p_light + p_cosine), with densities over area.
glm::dvec3 PathSampler::emission_of(const Hit& at, const glm::dvec3& direction, const Hit& next) const {
  const glm::dvec3 radiance = emitters_.radiance(next.point, -direction);
  if (radiance == glm::dvec3(0)) return radiance;
  const double distance = double{next.distance},
               light_cosine = std::abs(glm::dot(glm::dvec3(next.geometric), direction));
  const double cosine_density =
      glm::dot(glm::dvec3(at.normal), direction) * light_cosine / (distance * distance) / std::numbers::pi;
  return radiance * std::numbers::pi * cosine_density /
         (emitters_.density(next.point.triangle) + cosine_density);
}

/// Irradiance at `at` from a sampled direction of the sky: L cos / (p_light + p_cosine), with densities over solid angle.
glm::dvec3 PathSampler::sample_sky(const Hit& at, const glm::dvec2& random) {
  const SkySample sample = sky_.sample(random);
  const double cosine = glm::dot(glm::dvec3(at.normal), sample.direction);
  if (cosine <= 0 || glm::dot(glm::dvec3(at.geometric), sample.direction) <= 0) return glm::dvec3(0);
  ++ray_count_;
  if (rays_.occluded(rays_.offset_origin(at), glm::vec3(sample.direction), kInfinity)) return glm::dvec3(0);
  return sample.radiance * cosine / (sample.density + cosine / std::numbers::pi);
}

/// Irradiance at `at` from the sky along a cosine-distributed direction that hits no surface.
glm::dvec3 PathSampler::sky_along(const Hit& at, const glm::dvec3& direction) const {
  const double cosine = glm::dot(glm::dvec3(at.normal), direction);
  if (cosine <= 0) return glm::dvec3(0);
  return sky_.radiance(direction) * cosine / (sky_.density(direction) + cosine / std::numbers::pi);
}

glm::dvec3 PathSampler::indirect(const Hit& start, std::uint32_t path, std::uint64_t stream) {
  const Materials& materials = rays_.materials();
  glm::dvec3 sum(0), throughput(1);
  Hit at = start;
  for (int bounce = 1;; ++bounce) {
    const std::uint64_t dimensions = mix(stream, static_cast<std::uint64_t>(bounce));
    if (!emitters_.empty())
      sum += throughput * sample_emitter(at, sobol_point(path, mix(dimensions, kEmitterStream)));
    if (!sky_.empty()) sum += throughput * sample_sky(at, sobol_point(path, mix(dimensions, kSkyStream)));
    const glm::vec3 direction(cosine_direction(glm::dvec3(at.normal), sobol_point(path, dimensions)));
    if (glm::dot(direction, at.geometric) <= 0)
      break;  // below the triangle's plane, as the interpolated normal differs from the triangle's
    ++ray_count_;
    const std::optional<Hit> next =
        rays_.intersect(rays_.offset_origin(at), direction, 0, kInfinity, Faces::all);
    if (!next) {
      if (!sky_.empty()) sum += throughput * sky_along(at, glm::dvec3(direction));
      break;
    }
    if (!emitters_.empty()) sum += throughput * emission_of(at, glm::dvec3(direction), *next);
    const glm::dvec3 irradiance = direct(*next);
    const bool last = bounce == options_.bounces;
    if (last && irradiance == glm::dvec3(0)) break;  // frequent: saves the texture access
    throughput *= glm::dvec3(materials.albedo(next->point));
    sum += throughput * irradiance;
    if (last || !survives(throughput, bounce, mix(mix(dimensions), path))) break;
    at = *next;
  }
  return sum;
}

}  // namespace clpv::reference
