// SPDX-License-Identifier: MIT
#include "reference/shade.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "reference/lighting.hpp"
#include "reference/view.hpp"

namespace clpv::reference {
namespace {

/// Depth at which a pixel's ray meets the plane through `point`; infinite if it does not approach
/// the plane.
double plane_depth(const ClpvView& view, const glm::dvec2& pixel, const glm::dvec3& point,
                   const glm::dvec3& normal) {
  const glm::dvec3 at0 = surface_position(view, pixel.x, pixel.y, 0);
  const glm::dvec3 ray = surface_position(view, pixel.x, pixel.y, 1) - at0;  // advances depth by 1
  const double approach = glm::dot(normal, ray);
  if (approach >= 0) return std::numeric_limits<double>::infinity();
  return glm::dot(normal, point - at0) / approach;
}

double tap_weight(double distance) {
  return std::clamp(CLPV_SHADOW_TAPS / 2 - std::abs(distance), 0.0, 1.0);
}

}  // namespace

const ShadowMap& map_towards(const std::vector<ShadowMap>& maps, const glm::dvec3& offset) {
  const auto along = [&](const ShadowMap& map) {
    return glm::dot(offset, vector(map.view.forward));
  };
  return *std::max_element(maps.begin(), maps.end(), [&](const ShadowMap& a, const ShadowMap& b) {
    return along(a) < along(b);
  });
}

double visibility(const ShadowMap& map, const glm::dvec3& position, const glm::dvec3& normal,
                  double cosine) {
  const ProjectedPoint at = project(map.view, position);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double lift =
      pixel_edge(map.view, at.depth) * (CLPV_SHADOW_LIFT_FLAT + CLPV_SHADOW_LIFT_SLOPED * sine);
  const glm::dvec3 lifted = position + lift * normal;
  const double receiver = plane_depth(map.view, at.pixel, lifted, normal);
  double blocked = 0, total = 0;
  for (unsigned y = 0; y < map.view.height; ++y) {
    const double wy = tap_weight(y - at.pixel.y);
    for (unsigned x = 0; wy > 0 && x < map.view.width; ++x) {
      const double weight = wy * tap_weight(x - at.pixel.x);
      if (weight <= 0) continue;
      const double depth = map.depth[static_cast<std::size_t>(y) * map.view.width + x];
      const bool blocks =
          depth > 0 && depth < receiver && depth < plane_depth(map.view, {x, y}, lifted, normal);
      total += weight;
      blocked += blocks ? weight : 0;
    }
  }
  return total > 0 ? 1 - blocked / total : 1;
}

glm::dvec3 direct_irradiance(const MappedLight& light, const glm::dvec3& position,
                             const glm::dvec3& normal, const glm::dvec3& geometric) {
  const Incident incident = light_at(light.light, position);
  const double cosine = glm::dot(normal, incident.towards),
               facing = glm::dot(geometric, incident.towards);
  if (cosine <= 0 || facing <= 0) return glm::dvec3(0);
  if (light.maps.empty()) return cosine * incident.irradiance;
  const ShadowMap& map = map_towards(light.maps, position - vector(light.maps.front().view.eye));
  return cosine * visibility(map, position, geometric, facing) * incident.irradiance;
}

std::vector<glm::dvec3> direct_irradiance(const std::vector<MappedLight>& lights,
                                          const SurfaceImage& camera) {
  std::vector<glm::dvec3> image(camera.depth.size(), glm::dvec3(0));
  for (std::size_t pixel = 0; pixel < image.size(); ++pixel) {
    const double depth = camera.depth[pixel];
    if (depth <= 0) continue;
    const glm::dvec3 position = surface_position(camera.view, pixel, depth);
    for (const MappedLight& light : lights) {
      image[pixel] += direct_irradiance(light, position, glm::dvec3(camera.normal[pixel]),
                                        geometric_normal(camera.normal[pixel]));
    }
  }
  return image;
}

std::vector<glm::dvec4> shade(Show show, const SurfaceImage& camera,
                              const std::vector<glm::dvec3>& direct,
                              const std::vector<glm::dvec3>& indirect) {
  std::vector<glm::dvec4> image(camera.depth.size(), glm::dvec4(0));
  for (std::size_t pixel = 0; pixel < image.size(); ++pixel) {
    if (camera.depth[pixel] <= 0) continue;
    const glm::dvec3 albedo(camera.colour[pixel]);
    const glm::dvec3 emitted =
        camera.emissive.empty() ? glm::dvec3(0) : glm::dvec3(camera.emissive[pixel]);
    const glm::dvec3 from_lights = albedo / std::numbers::pi * direct[pixel] + emitted;
    const glm::dvec3 from_volumes = albedo / std::numbers::pi * indirect[pixel];
    glm::dvec3 shown(0);
    switch (show) {
      case Show::full:
        shown = from_lights + from_volumes;
        break;
      case Show::direct:
        shown = from_lights;
        break;
      case Show::indirect:
        shown = from_volumes;
        break;
      case Show::irradiance:
        shown = indirect[pixel];
        break;
      case Show::albedo:
        shown = albedo;
        break;
      case Show::normal:
        shown = glm::dvec3(camera.normal[pixel]);
        break;
      case Show::depth:
        shown = glm::dvec3(camera.depth[pixel]);
        break;
      case Show::medium:  // not views of surfaces
      case Show::cells:
        break;
    }
    image[pixel] = glm::dvec4(shown, 1);
  }
  return image;
}

}  // namespace clpv::reference
