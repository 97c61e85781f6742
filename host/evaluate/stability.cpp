// SPDX-License-Identifier: MIT
#include "evaluate/stability.hpp"

#include <algorithm>
#include <cmath>

#include "reference/view.hpp"

namespace clpv {
namespace {

// Normals of one surface, smooth ones included, from pixel to pixel: 8 degrees.
constexpr double kLeastCosine = 0.99;
// A point and the nearest pixel's lie in one plane to within so many pixels' edges: curved surfaces leave it by less.
constexpr double kOffPlane = 0.1;
// Along the surface they are at most half a pixel's diagonal apart across the view, and more where it slopes away.
constexpr double kApart = 0.75;

glm::dvec3 normal_of(const SurfaceImage& image, std::size_t pixel) {
  return glm::dvec3(image.normal[pixel]);
}

bool same_surface(const SurfaceImage& later, const glm::dvec3& point, const glm::dvec3& normal) {
  const reference::Projected at = reference::project(later.view, point);
  if (!(at.depth > later.view.near_depth)) return false;
  const double x = std::round(at.pixel.x), y = std::round(at.pixel.y);
  if (!(x >= 0 && x < later.view.width && y >= 0 && y < later.view.height)) return false;
  const std::size_t pixel = static_cast<std::size_t>(y) * later.view.width + static_cast<std::size_t>(x);
  if (later.depth[pixel] <= 0) return false;
  const glm::dvec3 there = reference::surface_position(later.view, x, y, double{later.depth[pixel]}),
                   off = there - point, there_normal = normal_of(later, pixel);
  const double edge = reference::pixel_edge(later.view, at.depth);
  const glm::dvec3 ray =
      glm::normalize(there - glm::dvec3(later.view.eye[0], later.view.eye[1], later.view.eye[2]));
  const double slope = std::max(std::abs(glm::dot(ray, there_normal)), 0.05);
  return glm::dot(normal, there_normal) > kLeastCosine &&
         std::abs(glm::dot(off, normal)) < kOffPlane * edge && glm::length(off) * slope < kApart * edge;
}

}  // namespace

std::vector<bool> still_seen(const SurfaceImage& earlier, const SurfaceImage& later) {
  std::vector<bool> seen(earlier.depth.size());
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (earlier.depth[i] <= 0) continue;
    const auto x = static_cast<double>(i % earlier.view.width),
               y = static_cast<double>(i / earlier.view.width);
    seen[i] = same_surface(later, reference::surface_position(earlier.view, x, y, double{earlier.depth[i]}),
                           normal_of(earlier, i));
  }
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

}  // namespace clpv
