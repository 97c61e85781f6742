// SPDX-License-Identifier: MIT
#include "reference/shade.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "kernels/shared/normal.h"
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

constexpr double kFarBelow = -1e30;  // [m]

/// First texel of the filter along an axis of `size` texels.
int first_tap(double texel, unsigned size) {
  constexpr double kTaps = CLPV_SHADOW_TAPS;
  const double at = std::clamp(texel, -kTaps, size + kTaps);
  return std::clamp(static_cast<int>(std::floor(at)) - 1, 0,
                    static_cast<int>(size) - CLPV_SHADOW_TAPS);
}

/// The texels of a receiver's filter and their heights above its plane (kernels/raster/shadow.h).
struct Filter {
  glm::dvec2 distance[CLPV_SHADOW_TAPS][CLPV_SHADOW_TAPS];  ///< [texels] from the receiver
  double depth[CLPV_SHADOW_TAPS][CLPV_SHADOW_TAPS];         ///< [m]; 0: no surface
  double height[CLPV_SHADOW_TAPS][CLPV_SHADOW_TAPS];        ///< [m]; kFarBelow without a surface
};

Filter filter_at(const ShadowMap& map, const glm::dvec2& pixel, const glm::dvec3& position,
                 const glm::dvec3& normal) {
  const int left = first_tap(pixel.x, map.view.width), top = first_tap(pixel.y, map.view.height);
  Filter filter;
  for (int row = 0; row < CLPV_SHADOW_TAPS; ++row) {
    for (int column = 0; column < CLPV_SHADOW_TAPS; ++column) {
      const int x = left + column, y = top + row;
      const double depth = map.depth[static_cast<std::size_t>(y) * map.view.width + x];
      filter.distance[row][column] = glm::dvec2(x, y) - pixel;
      filter.depth[row][column] = depth;
      filter.height[row][column] =
          depth > 0 ? glm::dot(normal, surface_position(map.view, x, y, depth) - position)
                    : kFarBelow;
    }
  }
  return filter;
}

/// Weights of the texels that occlude a receiver, and of all that count.
struct Share {
  double blocked = 0, whole = 0;
  double visible() const { return whole > 0 ? 1 - blocked / whole : 1; }
};

enum class Tap { blocks, passes, beyond };

/// Sums the weights of the texels by kind(row, column).
template <typename Kind>
Share weigh_taps(const Filter& filter, const Kind& kind) {
  Share share;
  for (int row = 0; row < CLPV_SHADOW_TAPS; ++row) {
    for (int column = 0; column < CLPV_SHADOW_TAPS; ++column) {
      const glm::dvec2& distance = filter.distance[row][column];
      const double weight = tap_weight(distance.x) * tap_weight(distance.y);
      const Tap tap = kind(row, column);
      share.blocked += tap == Tap::blocks ? weight : 0;
      share.whole += tap == Tap::beyond ? 0 : weight;
    }
  }
  return share;
}

/// Height of a surface of the map above the receiver [m]: the largest one of inner texels above
/// `rounding`, extrapolated to the receiver from higher outer neighbours; 0: it is below none.
double surface_above(const Filter& filter, double rounding) {
  double highest = 0;
  for (const int row : {1, 2}) {
    for (const int column : {1, 2}) {
      const double inner = filter.height[row][column],
                   beside = filter.height[row][column == 1 ? 0 : 3],
                   past = filter.height[row == 1 ? 0 : 3][column];
      const glm::dvec2 distance = glm::abs(filter.distance[row][column]);
      const double fall =
          std::max(beside - inner, 0.0) * distance.x + std::max(past - inner, 0.0) * distance.y;
      if (inner > rounding) highest = std::max(highest, inner - fall);
    }
  }
  return highest;
}

/// Returns true if the surface above a receiver meets its plane at a texel: if the heights of two
/// texels in a row, closer to the filter's centre, extrapolate to 0.
bool meets_surface(const Filter& filter, int row, int column, double rounding) {
  const int right = column < 2 ? 1 : -1, down = row < 2 ? 1 : -1;
  const auto meets = [&](double next, double past) {
    return next > rounding && std::abs(2 * next - past) < 2 * rounding;
  };
  return meets(filter.height[row][column + right], filter.height[row][column + 2 * right]) ||
         meets(filter.height[row + down][column], filter.height[row + 2 * down][column]);
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
                  double cosine, bool flat) {
  const ProjectedPoint at = project(map.view, position);
  const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double edge = pixel_edge(map.view, at.depth);
  const double lift = edge * std::min(CLPV_SHADOW_LIFT_FLAT + CLPV_SHADOW_LIFT_SLOPED * sine,
                                      CLPV_SHADOW_LIFT_DEPTH * cosine);
  const double rounding = edge * double{CLPV_SHADOW_ROUNDING_TEXELS} +
                          std::abs(at.depth) * double{CLPV_SHADOW_ROUNDING_DEPTH} +
                          (std::abs(position.x) + std::abs(position.y) + std::abs(position.z)) *
                              double{CLPV_SHADOW_ROUNDING_PLACE};
  const double farthest = plane_depth(map.view, at.pixel, position + lift * normal, normal);
  const Filter filter = filter_at(map, at.pixel, position, normal);
  const Share lifted = weigh_taps(filter, [&](int row, int column) {
    const double height = filter.height[row][column], depth = filter.depth[row][column];
    return height > lift && depth < farthest ? Tap::blocks : Tap::passes;
  });
  if (lifted.whole == 0) return 1;  // outside the map
  if (lifted.blocked >= double{CLPV_SHADOW_WHOLE} * lifted.whole) return 0;
  const double surface = flat ? surface_above(filter, rounding) : 0;
  if (surface <= 0) return lifted.visible();
  const Share below = weigh_taps(filter, [&](int row, int column) {
    const double height = filter.height[row][column];
    if (height > rounding) return Tap::blocks;
    return height > -rounding && !meets_surface(filter, row, column, rounding) ? Tap::passes
                                                                               : Tap::beyond;
  });
  const bool lit_beside = below.whole > below.blocked;
  return surface <= rounding && lit_beside ? lifted.visible() : below.visible();
}

glm::dvec3 direct_irradiance(const MappedLight& light, const glm::dvec3& position,
                             const glm::dvec3& normal, const glm::dvec3& geometric) {
  const Incident incident = light_at(light.light, position);
  const double cosine = glm::dot(normal, incident.towards),
               facing = glm::dot(geometric, incident.towards);
  if (cosine <= 0 || facing <= 0) return glm::dvec3(0);
  if (light.maps.empty()) return cosine * incident.irradiance;
  const bool flat = glm::dot(geometric, normal) > double{CLPV_SAME_NORMAL};
  if (!flat && facing <= double{CLPV_SHADOW_GRAZING}) return glm::dvec3(0);
  const ShadowMap& map = map_towards(light.maps, position - vector(light.maps.front().view.eye));
  return cosine * visibility(map, position, geometric, facing, flat) * incident.irradiance;
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
