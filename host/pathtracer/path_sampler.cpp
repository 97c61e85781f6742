// SPDX-License-Identifier: MIT
// Paths with next event estimation. Emitters and sky are sampled directly with density p_light, and
// hit by cosine-distributed directions with density p_cosine. The balance heuristic weights both
// (Veach and Guibas, 'Optimally combining sampling techniques for Monte Carlo rendering', SIGGRAPH
// 1995): each estimate is f / (p_light + p_cosine).
//
// A vertex in a medium has pi p, p the phase function, in place of a surface's cosine, and
// directions of density p in place of p_cosine. All free flights of a path are sampled for one
// channel, drawn at random, and weighted by the mean density of the three (Wilkie et al., 'Hero
// Wavelength Spectral Sampling', EGSR 2014). Suns light these vertices. For spots and points, a ray
// has a second sample, equiangular as seen from the light (Kulla and Fajardo, 'Importance Sampling
// Techniques for Path Tracing in Participating Media', EGSR 2012).
#include "pathtracer/path_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "basis/sampling.hpp"
#include "reference/view.hpp"
#include "scene/scene.hpp"

namespace clpv::pathtracer {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
// Random numbers of a bounce, besides those of its direction.
constexpr std::uint64_t kEmitterStream = 1, kSkyStream = 2, kFlightStream = 3, kBeamStream = 4;
constexpr std::uint64_t kAirStream = 1ull << 32, kChannelStream = kAirStream + 1,
                        kEyeBeamStream = kAirStream + 2;  // streams of a path, besides its bounces
constexpr int kCertainBounces = 3;                        // Russian roulette starts at this bounce
constexpr double kMaxSurvival = 0.95;                     // so that paths end between white walls
constexpr double kProbeFactor = 0.25;

/// Russian roulette. Returns false to end the path; else divides the throughput by the probability
/// of survival.
bool survives(glm::dvec3& throughput, int bounce, std::uint64_t bits) {
  const double largest = std::max({throughput.x, throughput.y, throughput.z});
  if (bounce < kCertainBounces) return largest > 0;
  const double survival = std::min(largest, kMaxSurvival);
  if (uniform(bits) >= survival) return false;
  throughput /= survival;
  return true;
}

double mean_of(const glm::dvec3& v) {
  return (v.x + v.y + v.z) / 3;
}

}  // namespace

void PathSampler::Flights::take(const glm::dvec3& more, glm::dvec3& throughput) {
  const double before = mean_of(density);
  density *= more;
  throughput *= before / mean_of(density);
  density /= std::max({density.x, density.y, density.z});
}

std::optional<Hit> PathSampler::primary_hit(const ClpvView& view, std::uint32_t px,
                                            std::uint32_t py) {
  ++ray_count_;
  const glm::dvec3 origin = reference::surface_position(view, px, py, 0),
                   at_unit_depth = reference::surface_position(view, px, py, 1);
  return rays_.intersect(glm::vec3(origin), glm::vec3(at_unit_depth - origin), view.near_depth,
                         view.far_depth, Faces::culled);
}

bool PathSampler::shadowed(const ClpvLight& light, const glm::vec3& origin,
                           const glm::dvec3& towards) const {
  if (kind_of(light) == LightKind::directional)
    return rays_.occluded(origin, glm::vec3(towards), kInfinity);
  const glm::vec3 to_light =
      glm::vec3(light.position[0], light.position[1], light.position[2]) - origin;
  return rays_.occluded(origin, to_light, 1);
}

glm::vec3 PathSampler::origin_of(const Vertex& at) const {
  return at.kind == Vertex::Kind::surface ? rays_.offset_origin(at.hit) : at.hit.position;
}

/// Vertex::Kind; 0 below the surface.
double PathSampler::factor(const Vertex& at, const glm::dvec3& direction) const {
  if (at.kind == Vertex::Kind::probe) return kProbeFactor;
  if (at.kind == Vertex::Kind::medium)
    return std::numbers::pi * phase(double{medium_->anisotropy}, glm::dot(direction, at.arrived));
  if (glm::dot(glm::dvec3(at.hit.geometric), direction) <= 0) return 0;
  return std::max(0.0, glm::dot(glm::dvec3(at.hit.normal), direction));
}

glm::dvec3 PathSampler::transmitted(const glm::vec3& origin, const glm::dvec3& direction,
                                    double distance) const {
  if (medium_ == nullptr) return glm::dvec3(1);
  return transmittance(*medium_, medium_part(*medium_, glm::dvec3(origin), direction, distance));
}

glm::dvec3 PathSampler::direct(const Vertex& at) {
  const glm::vec3 origin = origin_of(at);
  glm::dvec3 sum(0);
  for (const SceneLight& light : lights_) {
    if (at.kind == Vertex::Kind::medium && kind_of(light.data) != LightKind::directional)
      continue;  // from_beams()
    const reference::Incident in = reference::light_at(light.data, glm::dvec3(at.hit.position));
    const double cosine = factor(at, in.towards);
    if (cosine <= 0 || in.irradiance == glm::dvec3(0)) continue;
    ++ray_count_;
    if (!shadowed(light.data, origin, in.towards)) sum += in.irradiance * cosine;
  }
  return sum;
}

std::vector<reference::Incident> PathSampler::lights_at(const glm::vec3& position) {
  std::vector<reference::Incident> all;
  for (const SceneLight& light : lights_) {
    const reference::Incident in = reference::light_at(light.data, glm::dvec3(position));
    if (in.irradiance == glm::dvec3(0)) continue;
    ++ray_count_;
    if (!shadowed(light.data, position, in.towards)) all.push_back(in);
  }
  return all;
}

/// Radiance towards `origin` of light from spots and points, scattered once in a ray's first
/// `distance` [m]. Equi-angular sampling (Kulla and Fajardo 2012): points have the density D /
/// (angle (D^2 + (t - t_0)^2)), where D is the light's distance from the ray, t_0 its foot and
/// `angle` the angle subtended by the ray at the light.
glm::dvec3 PathSampler::from_beams(const glm::dvec3& origin, const glm::dvec3& direction,
                                   double distance, double random) {
  glm::dvec3 sum(0);
  if (medium_ == nullptr) return sum;
  const MediumPart part = medium_part(*medium_, origin, direction, distance);
  if (part.length() == 0) return sum;
  for (const SceneLight& light : lights_) {
    if (kind_of(light.data) == LightKind::directional) continue;
    const glm::dvec3 offset = vector(light.data.position) - origin;
    const double foot = glm::dot(offset, direction);
    const double away = std::max(glm::length(offset - foot * direction), 1e-6);
    const double first = std::atan((part.start - foot) / away),
                 last = std::atan((part.end - foot) / away);
    const double beside = away * std::tan(glm::mix(first, last, random)),
                 t = std::clamp(foot + beside, part.start, part.end);
    const glm::dvec3 at = origin + t * direction;
    const reference::Incident in = reference::light_at(light.data, at);
    if (in.irradiance == glm::dvec3(0)) continue;
    ++ray_count_;
    if (shadowed(light.data, glm::vec3(at), in.towards)) continue;
    const double density = away / ((last - first) * (away * away + beside * beside));
    sum += transmittance(*medium_, {part.start, t}) * in.irradiance *
           (phase(double{medium_->anisotropy}, glm::dot(in.towards, direction)) / density);
  }
  return vector(medium_->scattering) * sum;
}

/// Irradiance at `at` from a sampled emitter: L cos cos' / d^2 / (p_light + p_cosine), with
/// densities over area.
Arrival PathSampler::sample_emitter(const Vertex& at, const glm::dvec2& random) {
  const EmitterSample light = emitters_.sample(random);
  const glm::dvec3 to_light = glm::dvec3(light.position) - glm::dvec3(at.hit.position);
  const double square = glm::dot(to_light, to_light);
  if (!(square > 0)) return {};
  const glm::dvec3 direction = to_light / std::sqrt(square),
                   front = emitters_.front_normal(light.point.triangle);
  const double cosine = factor(at, direction), light_cosine = glm::dot(front, direction);
  if (cosine <= 0 || light_cosine == 0) return {};
  const glm::dvec3 radiance = emitters_.radiance(light.point, -direction);
  if (radiance == glm::dvec3(0) || rays_.materials().hole(light.point)) return {};
  Hit end;
  end.position = light.position, end.geometric = glm::vec3(light_cosine < 0 ? front : -front);
  end.point = light.point;
  const glm::vec3 origin = origin_of(at);
  ++ray_count_;
  if (rays_.occluded(origin, rays_.offset_origin(end) - origin, 1)) return {};
  // Both terms times d^2: finite at any distance.
  const double cosines = cosine * std::abs(light_cosine);
  return {direction, transmitted(origin, direction, std::sqrt(square)) * radiance * cosines /
                         (light.density * square + cosines / std::numbers::pi)};
}

/// Irradiance at `at` from the emissive surface `next` that a sampled direction hits: pi L p_cosine
/// / (p_light + p_cosine), with densities over area.
glm::dvec3 PathSampler::emission_of(const Vertex& at, const glm::dvec3& direction,
                                    const Hit& next) const {
  const glm::dvec3 radiance = emitters_.radiance(next.point, -direction);
  if (radiance == glm::dvec3(0)) return radiance;
  const double distance = double{next.distance},
               light_cosine = std::abs(glm::dot(glm::dvec3(next.geometric), direction));
  // p_cosine times d^2: finite at any distance.
  const double cosine_density = factor(at, direction) * light_cosine / std::numbers::pi;
  if (cosine_density == 0) return glm::dvec3(0);
  return radiance * std::numbers::pi * cosine_density /
         (emitters_.density(next.point.triangle) * distance * distance + cosine_density);
}

/// Irradiance at `at` from a sampled direction of the sky: L cos / (p_light + p_cosine), with
/// densities over solid angle.
Arrival PathSampler::sample_sky(const Vertex& at, const glm::dvec2& random) {
  const SkySample sample = sky_.sample(random);
  const double cosine = factor(at, sample.direction);
  if (cosine <= 0) return {};
  ++ray_count_;
  const glm::vec3 origin = origin_of(at);
  if (rays_.occluded(origin, glm::vec3(sample.direction), kInfinity)) return {};
  return {sample.direction, transmitted(origin, sample.direction, double{kInfinity}) *
                                sample.radiance * cosine /
                                (sample.density + cosine / std::numbers::pi)};
}

/// Irradiance at `at` from the sky along a sampled direction that hits no surface.
glm::dvec3 PathSampler::sky_along(const Vertex& at, const glm::dvec3& direction) const {
  const double cosine = factor(at, direction);
  if (cosine <= 0) return glm::dvec3(0);
  return sky_.radiance(direction) * cosine / (sky_.density(direction) + cosine / std::numbers::pi);
}

/// A free flight along a ray that meets a surface after `distance` [m]. Returns where the medium
/// scatters, or nothing if it does not before. Multiplies the throughput by transmittance, and
/// sigma_s of a scattering, over their probability.
std::optional<double> PathSampler::fly(const glm::vec3& origin, const glm::dvec3& direction,
                                       double distance, double random, Flights& flights,
                                       glm::dvec3& throughput) const {
  if (medium_ == nullptr) return std::nullopt;
  const MediumPart part = medium_part(*medium_, glm::dvec3(origin), direction, distance);
  if (part.length() == 0) return std::nullopt;
  const glm::dvec3 extinction = vector(medium_->extinction);
  const double chosen = extinction[flights.channel];
  const double flown = chosen > 0 ? -std::log1p(-random) / chosen : part.length();
  const bool passes = flown >= part.length();
  const glm::dvec3 left = glm::exp(-std::min(flown, part.length()) * extinction);
  flights.take(passes ? left : extinction * left, throughput);
  throughput *= passes ? left : left * vector(medium_->scattering);
  if (passes) return std::nullopt;
  return part.start + flown;
}

/// Direction of density factor() / pi; empty below the surface.
std::optional<glm::vec3> PathSampler::sample_direction(const Vertex& at,
                                                       const glm::dvec2& random) const {
  if (at.kind == Vertex::Kind::probe)
    return glm::vec3(phase_direction(glm::dvec3(0, 0, 1), 0, random));  // uniform
  if (at.kind == Vertex::Kind::medium)
    return glm::vec3(phase_direction(at.arrived, double{medium_->anisotropy}, random));
  const glm::vec3 direction(cosine_direction(glm::dvec3(at.hit.normal), random));
  // Below the triangle's plane, as the interpolated normal differs from the triangle's.
  if (glm::dot(direction, at.hit.geometric) <= 0) return std::nullopt;
  return direction;
}

namespace {

glm::dvec3 sum_of(const std::array<Arrival, 3>& arrivals) {
  return arrivals[0].light + arrivals[1].light + arrivals[2].light;
}

}  // namespace

glm::dvec3 PathSampler::indirect(const Vertex& start, std::uint32_t path, std::uint64_t stream) {
  return sum_of(arriving(start, path, stream));
}

std::array<Arrival, 3> PathSampler::arriving(const Vertex& start, std::uint32_t path,
                                             std::uint64_t stream) {
  return arriving(start, path, stream, {channel_of(path, stream), glm::dvec3(1)});
}

std::array<Arrival, 3> PathSampler::arriving(const Vertex& start, std::uint32_t path,
                                             std::uint64_t stream, Flights flights) {
  const reference::Materials& materials = rays_.materials();
  std::array<Arrival, 3> arrivals;
  auto& [emitter, sky, rest] = arrivals;
  glm::dvec3& sum = rest.light;
  glm::dvec3 throughput(1);
  Vertex at = start;
  for (int bounce = 1;; ++bounce) {
    const std::uint64_t dimensions = mix(stream, static_cast<std::uint64_t>(bounce));
    const auto add = [&](Arrival& first, const Arrival& sampled) {
      if (bounce == 1) {
        first = sampled;
      } else {
        sum += throughput * sampled.light;
      }
    };
    if (!emitters_.empty())
      add(emitter, sample_emitter(at, sobol_point(path, mix(dimensions, kEmitterStream))));
    if (!sky_.empty()) add(sky, sample_sky(at, sobol_point(path, mix(dimensions, kSkyStream))));
    const std::optional<glm::vec3> direction = sample_direction(at, sobol_point(path, dimensions));
    if (!direction) break;
    if (bounce == 1) rest.direction = glm::dvec3(*direction);
    ++ray_count_;
    const glm::vec3 origin = origin_of(at);
    const std::optional<Hit> hit = rays_.intersect(origin, *direction, 0, kInfinity, Faces::all);
    const double distance = hit ? double{hit->distance} : double{kInfinity};
    sum += throughput * std::numbers::pi *
           from_beams(glm::dvec3(origin), glm::dvec3(*direction), distance,
                      sobol_point(path, mix(dimensions, kBeamStream)).x);
    const std::optional<double> scattered =
        fly(origin, glm::dvec3(*direction), distance,
            sobol_point(path, mix(dimensions, kFlightStream)).x, flights, throughput);
    if (!hit && !scattered) {
      if (!sky_.empty()) sum += throughput * sky_along(at, glm::dvec3(*direction));
      break;
    }
    const Vertex next = scattered
                            ? in_medium(glm::dvec3(origin), glm::dvec3(*direction), *scattered)
                            : Vertex{*hit};
    if (!scattered && !emitters_.empty())
      sum += throughput * emission_of(at, glm::dvec3(*direction), *hit);
    const glm::dvec3 irradiance = direct(next);
    const bool last = bounce == options_.bounces;
    if (last && irradiance == glm::dvec3(0)) break;  // frequent: saves the texture access
    if (!scattered) throughput *= glm::dvec3(materials.albedo(hit->point));
    sum += throughput * irradiance;
    if (last || !survives(throughput, bounce, mix(mix(dimensions), path))) break;
    at = next;
  }
  return arrivals;
}

glm::dvec3 PathSampler::scattered_towards(const glm::dvec3& origin, const glm::dvec3& direction,
                                          double distance, std::uint32_t path,
                                          std::uint64_t stream) {
  const MediumPart part = medium_part(*medium_, origin, direction, distance);
  const glm::dvec3 extinction = vector(medium_->extinction);
  if (part.length() == 0) return glm::dvec3(0);
  // Density sigma exp(-sigma t) / (1 - exp(-sigma l)) of each channel: every point of the ray can
  // be drawn.
  const std::uint64_t own = mix(stream, kAirStream);
  Flights flights{channel_of(path, own), glm::dvec3(1)};
  const double chosen = extinction[flights.channel], random = sobol_point(path, own).x;
  const double t =
      chosen > 0 ? std::min(-std::log1p(random * std::expm1(-chosen * part.length())) / chosen,
                            part.length())
                 : random * part.length();
  const glm::dvec3 left = glm::exp(-t * extinction);
  glm::dvec3 density, throughput = left * vector(medium_->scattering);
  for (int c = 0; c < 3; ++c)
    density[c] = extinction[c] > 0
                     ? extinction[c] * left[c] / -std::expm1(-extinction[c] * part.length())
                     : 1 / part.length();
  flights.take(density, throughput);
  const Vertex at = in_medium(origin, direction, part.start + t);
  return from_beams(origin, direction, distance, sobol_point(path, mix(stream, kEyeBeamStream)).x) +
         throughput * (direct(at) + sum_of(arriving(at, path, own, flights))) / std::numbers::pi;
}

int PathSampler::channel_of(std::uint32_t path, std::uint64_t stream) {
  return static_cast<int>(3 * sobol_point(path, mix(stream, kChannelStream)).x);
}

PathSampler::Vertex PathSampler::in_medium(const glm::dvec3& origin, const glm::dvec3& direction,
                                           double distance) {
  Vertex vertex{{}, Vertex::Kind::medium, direction};
  vertex.hit.position = glm::vec3(origin + distance * direction);
  return vertex;
}

}  // namespace clpv::pathtracer
