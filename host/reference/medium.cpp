// SPDX-License-Identifier: MIT
#include "reference/medium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "basis/sampling.hpp"
#include "basis/sweep.hpp"
#include "kernels/shared/pixel_planes.h"
#include "reference/cascade_sample.hpp"
#include "reference/lighting.hpp"
#include "reference/view.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {
namespace {

// kernels/gather/medium.cl
constexpr int kStep = 2, kWindow = 2;
constexpr double kSameEnd = 0.1, kUnlike = 1e-3, kThin = 1e-3;
constexpr int kBayer[CLPV_PLANE_TILE][CLPV_PLANE_TILE] = {
    {0, 8, 2, 10}, {12, 4, 14, 6}, {3, 11, 1, 9}, {15, 7, 13, 5}};

/// The part of a pixel's ray in the medium.
struct AirRay {
  glm::dvec3 origin{0}, direction{0};  ///< unit
  MediumPart part;                     ///< [m]; 0 to 0 outside the medium
};

AirRay air_ray(const ClpvMedium& medium, const SurfaceImage& camera, unsigned x, unsigned y) {
  const glm::dvec3 origin = surface_position(camera.view, x, y, 0),
                   along = surface_position(camera.view, x, y, 1) - origin;
  const double depth = camera.depth[std::size_t{y} * camera.view.width + x],
               length = glm::length(along);
  const double end = depth > 0 ? depth * length : std::numeric_limits<double>::infinity();
  const MediumPart part = medium_part(medium, origin, along / length, end);
  return {origin, along / length, part.length() > 0 ? part : MediumPart{}};
}

/// A point of a ray, and exp(-sigma_t (t - start)) dt [m].
struct AirPoint {
  glm::dvec3 position{0}, share{0};
};

AirPoint air_point(const ClpvMedium& medium, const AirRay& ray, double x, int steps) {
  const glm::dvec3 extinction = vector(medium.extinction);
  const double sigma = (extinction.x + extinction.y + extinction.z) / 3, length = ray.part.length();
  const bool thin = sigma * length < kThin;
  const double reached = -std::expm1(-sigma * length);
  const double t = thin ? x * length : -std::log1p(-x * reached) / sigma;
  const double step = (thin ? length : reached * std::exp(sigma * t) / sigma) / steps;
  return {ray.origin + (ray.part.start + t) * ray.direction, step * glm::exp(-t * extinction)};
}

/// Returns true if a light reaches a point in the air: the nearest texel of its map.
bool reaches(const MappedLight& light, const glm::dvec3& position) {
  if (light.maps.empty()) return true;
  const ShadowMap& map = map_towards(light.maps, position - vector(light.maps.front().view.eye));
  const ProjectedPoint at = project(map.view, position);
  const double x = std::floor(at.pixel.x + 0.5), y = std::floor(at.pixel.y + 0.5);
  if (!(at.depth > 0 && x >= 0 && y >= 0 && x < map.view.width && y < map.view.height)) return true;
  const double nearest =
      map.depth[static_cast<std::size_t>(y) * map.view.width + static_cast<std::size_t>(x)];
  return !(nearest > 0 && nearest < at.depth);
}

/// Light scattered along a pixel's ray towards the camera. `place` in (0, 1): position of each
/// point in its interval.
glm::dvec3 scattered_along(const Basis& basis, const MediumOptions& options,
                           const MediumScene& scene, const AirRay& ray, double place) {
  glm::dvec3 sum(0);
  const double g = double{scene.medium.anisotropy};
  for (int k = 0; k < options.volume_steps; ++k) {
    const AirPoint point =
        air_point(scene.medium, ray, (k + place) / options.volume_steps, options.volume_steps);
    RadianceField field =
        radiance_field(options.gather, scene.cascades, basis.size(), point.position);
    for (std::vector<double>& channel : field) {
      for (std::size_t i = 1; i < channel.size(); ++i) channel[i] *= i < 4 ? g : g * g;
    }
    sum += point.share * glm::max(radiance(basis, field, -ray.direction), 0.0);
  }
  for (const MappedLight& light : scene.lights) {
    for (int k = 0; k < options.light_steps; ++k) {
      const AirPoint point =
          air_point(scene.medium, ray, (k + place) / options.light_steps, options.light_steps);
      const Incident incident = light_at(light.light, point.position);
      if (reaches(light, point.position))
        sum +=
            point.share * incident.irradiance * phase(g, glm::dot(incident.towards, ray.direction));
    }
  }
  return vector(scene.medium.scattering) * sum;
}

/// The part of attenuated light that is scattered.
double albedo(const ClpvMedium& medium, int channel) {
  const double extinction = double{medium.extinction[channel]};
  return extinction > 0 ? double{medium.scattering[channel]} / extinction : 0;
}

/// Weight of a ray's neighbour, whose end is `other` [m]; 0 outside the medium.
double alike(double end, double other) {
  return other > 0 ? std::max(0.0, 1 - std::abs(end - other) / (kSameEnd * std::max(end, other)))
                   : 0;
}

/// Rays of every second pixel along both axes, with the light that they see.
struct AirImage {
  int width = 0, height = 0;
  std::vector<double> ends;
  std::vector<glm::dvec3> light;

  double end(int x, int y) const {
    return x < 0 || y < 0 || x >= width || y >= height ? 0 : ends[y * width + x];
  }
};

/// Sum of light and weights.
struct WeightedMean {
  glm::dvec3 sum{0};
  double weights = 0;

  void add(const AirImage& image, int x, int y, double end, double share) {
    const double weight = share * alike(end, image.end(x, y));
    if (!(weight > 0)) return;
    sum += weight * image.light[y * image.width + x];
    weights += weight;
  }
};

AirImage blurred(const AirImage& image) {
  AirImage result = image;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      WeightedMean mean;
      for (int dy = -kWindow; dy <= kWindow; ++dy) {
        for (int dx = -kWindow; dx <= kWindow; ++dx) {
          const double share =
              (std::abs(dy) == kWindow ? 0.5 : 1) * (std::abs(dx) == kWindow ? 0.5 : 1);
          mean.add(image, x + dx, y + dy, image.end(x, y), share);
        }
      }
      result.light[y * image.width + x] =
          mean.weights > 0 ? mean.sum / mean.weights : glm::dvec3(0);
    }
  }
  return result;
}

}  // namespace

std::vector<glm::dvec3> scattered_light(const Basis& basis, const MediumOptions& options,
                                        const MediumScene& scene, const SurfaceImage& camera) {
  const ClpvView& view = camera.view;
  AirImage traced{
      int(view.width + kStep - 1) / kStep, int(view.height + kStep - 1) / kStep, {}, {}};
  for (int y = 0; y < traced.height; ++y) {
    for (int x = 0; x < traced.width; ++x) {
      const AirRay ray = air_ray(scene.medium, camera, kStep * x, kStep * y);
      const double place = (kBayer[y % CLPV_PLANE_TILE][x % CLPV_PLANE_TILE] + 0.5) / 16;
      const bool inside = ray.part.length() > 0;
      traced.ends.push_back(inside ? ray.part.end : 0);
      traced.light.push_back(inside ? scattered_along(basis, options, scene, ray, place)
                                    : glm::dvec3(0));
    }
  }
  const AirImage mean = blurred(traced);
  std::vector<glm::dvec3> light;
  for (unsigned pixel = 0; pixel < view.width * view.height; ++pixel) {
    const int x = pixel % view.width, y = pixel / view.width, left = x / kStep, above = y / kStep;
    const AirRay ray = air_ray(scene.medium, camera, x, y);
    WeightedMean interpolated;
    for (int corner = 0; corner < 4; ++corner)
      interpolated.add(mean, left + corner % 2 * (x % 2), above + corner / 2 * (y % 2),
                       ray.part.end, 1);
    interpolated.sum += kUnlike * mean.light[above * mean.width + left];
    interpolated.weights += kUnlike;
    light.push_back(ray.part.length() > 0 ? interpolated.sum / interpolated.weights
                                          : glm::dvec3(0));
  }
  return light;
}

Volume scattered_in_cells(const ClpvMedium& medium, const std::vector<MappedLight>& lights,
                          const ClpvGrid& grid) {
  Volume scattered(static_cast<int>(grid.n), kSweepBins, 3);
  const std::vector<SweepBin> bins = sweep_bins(1);
  const glm::dvec3 lower = vector(medium.lower), upper = vector(medium.upper);
  const double cell = double{grid.cell};
  for_each_cell(scattered.n, [&](const glm::ivec3& p) {
    const glm::dvec3 corner = vector(grid.origin) + cell * glm::dvec3(p);
    if (glm::any(glm::greaterThanEqual(corner, upper)) ||
        glm::any(glm::lessThanEqual(corner + cell, lower)))
      return;
    for (const MappedLight& light : lights) {
      const bool directional = light.light.kind == CLPV_LIGHT_DIRECTIONAL;
      glm::dvec3 irradiance(0);
      for (int i = 0; i < 8; ++i) {
        const glm::dvec3 offset = 0.25 + 0.5 * glm::dvec3(i & 1, i >> 1 & 1, i >> 2),
                         point = glm::clamp(corner + cell * offset, lower, upper);
        if (!reaches(light, point)) continue;
        const double near =
            directional ? 1 : 4 / cell * glm::distance(point, vector(light.light.position));
        irradiance += light_at(light.light, point).irradiance / 8.0 * std::min(1.0, near * near);
      }
      glm::dvec3 along = vector(light.light.direction);
      if (!directional) {
        const glm::dvec3 offset = corner + 0.5 * cell - vector(light.light.position);
        along = offset / std::max(glm::length(offset), 1e-6 * cell);
      }
      std::vector<double> phases;
      double integral = 0;
      for (const SweepBin& bin : bins) {
        phases.push_back(
            phase(double{medium.anisotropy}, glm::dot(along, bin.directions.front().w)));
        integral += phases.back() * 4 * std::numbers::pi / kSweepBins;
      }
      for (int c = 0; c < 3; ++c) {
        for (int b = 0; b < kSweepBins; ++b)
          scattered.at(c, b, p.x, p.y, p.z) +=
              albedo(medium, c) * cell * cell * irradiance[c] * phases[b] / integral;
      }
    }
  });
  return scattered;
}

void add_scattered(const ClpvMedium& medium, const Volume& swept, Volume& scattered) {
  const Matrix scattering = scattering_matrix(double{medium.anisotropy});
  for_each_cell(swept.n, [&](const glm::ivec3& p) {
    for (int c = 0; c < 3; ++c) {
      const std::vector<double> added = scattering * swept.cell(c, p);
      for (int b = 0; b < kSweepBins; ++b)
        scattered.at(c, b, p.x, p.y, p.z) += albedo(medium, c) * added[b];
    }
  });
}

}  // namespace clpv::reference
