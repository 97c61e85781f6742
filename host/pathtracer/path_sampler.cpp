// SPDX-License-Identifier: MIT
#include "pathtracer/path_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "pathtracer/sampling.hpp"
#include "reference/lighting.hpp"
#include "reference/view.hpp"
#include "scene/light_kind.hpp"

namespace clpv::reference {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint64_t kOfEmitters = 1, kOfSky = 2;  // streams of their own
constexpr int kCertainBounces = 3;                    // further ones are played Russian roulette for
constexpr double kMostSurvival = 0.95;                // of roulette: paths end even between white walls

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

/// What a point picked on an emissive surface sends to `at`, its share of it (docs/quality.md, 'The truth').
glm::dvec3 PathSampler::looked_for(const Hit& at, const glm::dvec2& point) {
  const EmitterPoint there = emitters_.pick(point);
  const glm::dvec3 way = glm::dvec3(there.position) - glm::dvec3(at.position);
  const double square = glm::dot(way, way);
  if (!(square > 0)) return glm::dvec3(0);
  const glm::dvec3 direction = way / std::sqrt(square), front = emitters_.front(there.point.triangle);
  const double here = glm::dot(glm::dvec3(at.normal), direction), slant = glm::dot(front, direction);
  if (here <= 0 || glm::dot(glm::dvec3(at.geometric), direction) <= 0 || slant == 0) return glm::dvec3(0);
  const glm::dvec3 radiance = emitters_.radiance(there.point, -direction);
  if (radiance == glm::dvec3(0) || rays_.materials().hole(there.point)) return glm::dvec3(0);
  Hit end;
  end.position = there.position, end.geometric = glm::vec3(slant < 0 ? front : -front);
  const glm::vec3 origin = rays_.leave(at);
  ++shot_;
  if (rays_.occluded(origin, rays_.leave(end) - origin, 1)) return glm::dvec3(0);
  const double factor = here * std::abs(slant) / square;
  return radiance * factor / (there.density + factor / std::numbers::pi);
}

/// What an emissive surface that a path met sends back along it, the rest of it.
glm::dvec3 PathSampler::met(const Hit& at, const glm::dvec3& direction, const Hit& next) const {
  const glm::dvec3 radiance = emitters_.radiance(next.point, -direction);
  if (radiance == glm::dvec3(0)) return radiance;
  const double distance = double{next.distance},
               slant = std::abs(glm::dot(glm::dvec3(next.geometric), direction));
  const double by_chance =
      glm::dot(glm::dvec3(at.normal), direction) * slant / (distance * distance) / std::numbers::pi;
  return radiance * std::numbers::pi * by_chance / (emitters_.density(next.point.triangle) + by_chance);
}

/// What a direction picked of the sky sends to `at`, its share of it.
glm::dvec3 PathSampler::looked_up(const Hit& at, const glm::dvec2& point) {
  const SkyDirection there = sky_.pick(point);
  const double here = glm::dot(glm::dvec3(at.normal), there.direction);
  if (here <= 0 || glm::dot(glm::dvec3(at.geometric), there.direction) <= 0) return glm::dvec3(0);
  ++shot_;
  if (rays_.occluded(rays_.leave(at), glm::vec3(there.direction), kInfinity)) return glm::dvec3(0);
  return there.radiance * here / (there.density + here / std::numbers::pi);
}

/// What the sky sends along a path that met nothing, the rest of it.
glm::dvec3 PathSampler::missed(const Hit& at, const glm::dvec3& direction) const {
  const double here = glm::dot(glm::dvec3(at.normal), direction);
  if (here <= 0) return glm::dvec3(0);
  return sky_.radiance(direction) * here / (sky_.density(direction) + here / std::numbers::pi);
}

glm::dvec3 PathSampler::indirect(const Hit& start, std::uint32_t path, std::uint64_t stream) {
  const Materials& materials = rays_.materials();
  glm::dvec3 sum(0), throughput(1);
  Hit at = start;
  for (int bounce = 1;; ++bounce) {
    const std::uint64_t dimensions = mix(stream, static_cast<std::uint64_t>(bounce));
    if (!emitters_.none())
      sum += throughput * looked_for(at, sobol_point(path, mix(dimensions, kOfEmitters)));
    if (!sky_.none()) sum += throughput * looked_up(at, sobol_point(path, mix(dimensions, kOfSky)));
    const glm::vec3 direction(cosine_direction(glm::dvec3(at.normal), sobol_point(path, dimensions)));
    if (glm::dot(direction, at.geometric) <= 0)
      break;  // into the surface: an interpolated normal leans that far
    ++shot_;
    const std::optional<Hit> next = rays_.intersect(rays_.leave(at), direction, 0, kInfinity, Faces::both);
    if (!next) {
      if (!sky_.none()) sum += throughput * missed(at, glm::dvec3(direction));
      break;
    }
    if (!emitters_.none()) sum += throughput * met(at, glm::dvec3(direction), *next);
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
