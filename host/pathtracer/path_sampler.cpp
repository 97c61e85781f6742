// SPDX-License-Identifier: MIT
#include "pathtracer/path_sampler.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "pathtracer/sampling.hpp"
#include "reference/lighting.hpp"
#include "reference/view.hpp"
#include "scene/light_kind.hpp"

namespace clpv::reference {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kCertainBounces = 3;      // further ones are played Russian roulette for
constexpr double kMostSurvival = 0.95;  // of roulette: paths end even between white walls

/// Russian roulette: whether a path goes on, its throughput then raised so that the mean stays.
bool survives(glm::dvec3& throughput, int bounce, std::uint64_t bits) {
  const double most = std::max({throughput.x, throughput.y, throughput.z});
  if (bounce < kCertainBounces) return most > 0;
  const double survival = std::min(most, kMostSurvival);
  if (unit(bits) >= survival) return false;
  throughput /= survival;
  return true;
}

}  // namespace

std::optional<Hit> PathSampler::see(const ClpvView& view, std::uint32_t px, std::uint32_t py) {
  ++shot_;
  const glm::dvec3 origin = surface_position(view, px, py, 0), one_on = surface_position(view, px, py, 1);
  return rays_.intersect(glm::vec3(origin), glm::vec3(one_on - origin), view.near_depth, view.far_depth,
                         Faces::as_seen);
}

bool PathSampler::shadowed(const ClpvLight& light, const glm::vec3& origin, const glm::dvec3& towards) const {
  if (kind_of(light) == LightKind::directional) return rays_.occluded(origin, glm::vec3(towards), kInfinity);
  const glm::vec3 path = glm::vec3(light.position[0], light.position[1], light.position[2]) - origin;
  return rays_.occluded(origin, path, 1);
}

glm::dvec3 PathSampler::direct(const Hit& hit) {
  const glm::vec3 origin = rays_.leave(hit);
  glm::dvec3 sum(0);
  for (const Light& light : lights_) {
    const Incident in = light_at(light.data, glm::dvec3(hit.position));
    const double cosine = glm::dot(glm::dvec3(hit.normal), in.towards);
    if (cosine <= 0 || glm::dot(glm::dvec3(hit.geometric), in.towards) <= 0) continue;
    if (in.irradiance == glm::dvec3(0)) continue;
    ++shot_;
    if (!shadowed(light.data, origin, in.towards)) sum += in.irradiance * cosine;
  }
  return sum;
}

glm::dvec3 PathSampler::indirect(const Hit& start, std::uint32_t path, std::uint64_t stream) {
  const Materials& materials = rays_.materials();
  glm::dvec3 sum(0), throughput(1);
  Hit at = start;
  for (int bounce = 1;; ++bounce) {
    const std::uint64_t dimensions = mix(stream, static_cast<std::uint64_t>(bounce));
    const glm::vec3 direction(cosine_direction(glm::dvec3(at.normal), sobol_point(path, dimensions)));
    if (glm::dot(direction, at.geometric) <= 0)
      break;  // into the surface: an interpolated normal leans that far
    ++shot_;
    const std::optional<Hit> next = rays_.intersect(rays_.leave(at), direction, 0, kInfinity, Faces::both);
    if (!next) break;
    if (options_.emissive_lights) {
      sum += throughput * glm::dvec3(materials.emissive(next->point)) * std::numbers::pi;
    }
    const glm::dvec3 lit = direct(*next);
    const bool last = bounce == options_.bounces;
    if (last && lit == glm::dvec3(0)) break;  // most last bounces: spares them the look at textures
    throughput *= glm::dvec3(materials.albedo(next->point));
    sum += throughput * lit;
    if (last || !survives(throughput, bounce, mix(mix(dimensions), path))) break;
    at = *next;
  }
  return sum;
}

}  // namespace clpv::reference
