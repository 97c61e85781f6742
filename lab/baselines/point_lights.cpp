// SPDX-License-Identifier: MIT
// Baseline: virtual point lights from reflective shadow maps.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <numbers>

#include "baselines/methods.hpp"
#include "basis/sampling.hpp"
#include "reference/view.hpp"

namespace clpv::baselines {
namespace {

/// Lift of a light off its surface [texels of the RSM]: the rasteriser's vertices lie on a lattice
/// of 1/256 texel.
constexpr double kLift = 1.0 / 32;
constexpr double kGrazing = 0.05;  // smallest cosine that divides an area

double brightness(const glm::vec4& flux) {
  return double{std::max(flux.x, 0.0f)} + double{std::max(flux.y, 0.0f)} +
         double{std::max(flux.z, 0.0f)};
}

/// Every second bit, from the lowest: a coordinate of Morton's curve.
std::uint32_t even_bits(std::uint32_t x) {
  x &= 0x55555555u;
  x = (x | (x >> 1)) & 0x33333333u;
  x = (x | (x >> 2)) & 0x0f0f0f0fu;
  x = (x | (x >> 4)) & 0x00ff00ffu;
  return (x | (x >> 8)) & 0x0000ffffu;
}

/// One of `share` lights, among which a texel's flux is divided.
PointLight light_of(const SurfaceImage& rsm, std::size_t texel, double share) {
  const glm::dvec3 normal(rsm.normal[texel]),
      position = reference::surface_position(rsm.view, texel, rsm.depth[texel]);
  const auto x = static_cast<double>(texel % rsm.view.width),
             y = static_cast<double>(texel / rsm.view.width);
  const glm::dvec3 ray = glm::normalize(reference::surface_position(rsm.view, x, y, 2) -
                                        reference::surface_position(rsm.view, x, y, 1));
  const double area = reference::footprint(rsm.view, x, y, double{rsm.depth[texel]}) /
                      std::max(kGrazing, -glm::dot(ray, normal));
  const double lift = kLift * reference::pixel_edge(rsm.view, double{rsm.depth[texel]});
  return {glm::vec3(position + lift * normal), glm::vec3(normal),
          glm::vec3(rsm.colour[texel]) / float(share), static_cast<float>(area / share)};
}

}  // namespace

std::vector<PointLight> draw_lights(std::span<const SurfaceImage> rsms, unsigned count) {
  struct Texel {
    const SurfaceImage* rsm;
    std::size_t index;
    double flux, end;  ///< `end`: sum of the flux up to this one
  };
  std::vector<Texel> lit;
  double total = 0;
  for (const SurfaceImage& rsm : rsms) {
    // Along Morton's curve, so that equal intervals of flux are compact patches.
    const std::uint32_t edge = std::bit_ceil(std::max(rsm.view.width, rsm.view.height));
    for (std::uint32_t i = 0; i < edge * edge; ++i) {
      const std::uint32_t x = even_bits(i), y = even_bits(i >> 1);
      if (x >= rsm.view.width || y >= rsm.view.height) continue;
      const std::size_t texel = std::size_t{y} * rsm.view.width + x;
      const double flux = rsm.depth[texel] > 0 ? brightness(rsm.colour[texel]) : 0;
      if (flux > 0) lit.push_back({&rsm, texel, flux, total += flux});
    }
  }
  std::vector<PointLight> lights;
  for (std::size_t i = 0, at = 0; !lit.empty() && i < count; ++i) {
    // One in each interval.
    const double drawn = (static_cast<double>(i) + uniform(mix(1, i))) / count * total;
    while (at + 1 < lit.size() && lit[at].end <= drawn) ++at;
    lights.push_back(light_of(*lit[at].rsm, lit[at].index, count * lit[at].flux / total));
  }
  return lights;
}

Irradiance light_by(const View& view, std::span<const PointLight> lights, unsigned interleave) {
  const unsigned width = view.width(), sets = interleave * interleave;
  Irradiance image(view.hits().size());
  view.for_each_pixel([&](pathtracer::PathSampler&, std::size_t pixel) {
    const pathtracer::Hit& hit = *view.hits()[pixel];
    const glm::vec3 origin = view.rays().offset_origin(hit);
    const auto x = static_cast<unsigned>(pixel % width), y = static_cast<unsigned>(pixel / width);
    glm::vec3 sum(0);
    for (std::size_t i = x % interleave + interleave * (y % interleave); i < lights.size();
         i += sets) {
      const PointLight& light = lights[i];
      const glm::vec3 to_light = light.position - origin;
      const float sent = -glm::dot(light.normal, to_light),
                  received = glm::dot(hit.normal, to_light);
      if (sent <= 0 || received <= 0 || glm::dot(hit.geometric, to_light) <= 0) continue;
      const float square = glm::dot(to_light, to_light);
      if (view.rays().occluded(origin, to_light, 1)) continue;
      sum += light.flux *
             (sent * received / (square * (std::numbers::pi_v<float> * square + light.area)));
    }
    image.set(pixel, float(sets) * sum);
  });
  return image;
}

}  // namespace clpv::baselines
