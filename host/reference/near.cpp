// SPDX-License-Identifier: MIT
#include "reference/near.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "basis/near_directions.hpp"
#include "kernels/shared/near.h"
#include "reference/cascade_sample.hpp"
#include "reference/radiance.hpp"
#include "reference/triangle.hpp"
#include "reference/view.hpp"

namespace clpv::reference {
namespace {

constexpr double kSameNormal = 0.7, kSamePlane = 0.1, kWidened = 0.2;  // near_filter.cl
constexpr double kLeastArriving = 0.5;                                 // near.cl

bool close_to(double value, double limit) {
  return std::abs(value - limit) < kNearEdge * std::max(1.0, std::abs(limit));
}

/// A traced pixel.
struct NearPoint {
  glm::dvec3 position{0}, normal{0};
  double reach = 0;  ///< [m]; 0 without a surface in a cascade
  glm::dvec3 difference{0};
  bool uncertain = false;
};

struct NearField {
  const Basis& basis;
  const NearOptions& options;
  const NearScene& scene;

  double reach_at(const glm::dvec3& position) const;
  RadianceField field_at(const glm::dvec3& position, double offset, const glm::dvec3& lift) const {
    return radiance_field(options.gather, scene.cascades, basis.size(), position, offset, lift);
  }
  double trust(const RadianceField& field, const glm::dvec3& normal) const;
  glm::dvec3 radiance_of(const NearHit& hit, const NearPoint& point, const glm::dvec3& along,
                         bool& uncertain) const;
  void trace(NearPoint& point, const std::vector<glm::vec3>& directions) const;
};

double NearField::reach_at(const glm::dvec3& position) const {
  double reach = 0, rest = 1;
  for (const Cascade& cascade : scene.cascades) {
    const double share = share_of(position, cascade.grid, options.gather.grid, options.gather.blend_cells);
    reach += share * rest * double{cascade.grid.cell};
    rest *= 1 - share;
  }
  return reach;
}

double sum(const glm::dvec3& v) {
  return v.x + v.y + v.z;
}

/// Weight of the correction for rays that miss.
double NearField::trust(const RadianceField& field, const glm::dvec3& normal) const {
  const double arriving = sum(field_irradiance(basis, field, normal)),
               leaving = sum(field_irradiance(basis, field, -normal));
  return arriving >= kLeastArriving * leaving ? 1 : arriving / (kLeastArriving * leaving);
}

/// Radiance of a hit towards the ray's origin.
glm::dvec3 NearField::radiance_of(const NearHit& hit, const NearPoint& point, const glm::dvec3& along,
                                  bool& uncertain) const {
  const Triangle& triangle = scene.scene.triangles[hit.point.triangle];
  const auto [a, b, c] = corners_of(scene.scene, triangle);
  const glm::dvec3 across = glm::cross(b - a, c - a);
  const double area2 = glm::length(across);
  const double height = std::abs(glm::dot(point.position - a, across)) / (area2 * point.reach);
  uncertain = uncertain || std::abs(height - 2 * double{CLPV_NEAR_LIFT}) < 0.1 * double{CLPV_NEAR_LIFT};
  if (height <= 2 * double{CLPV_NEAR_LIFT}) return glm::dvec3(0);
  const bool back = glm::dot(across, along) > 0;
  const glm::dvec3 front = back ? -across : across;
  glm::dvec3 n(interpolate(scene.scene, triangle, hit.point.weights, normal));
  if (glm::dot(n, n) == 0) n = front;
  n = glm::normalize(n);
  if (glm::dot(n, front) < 0) n = -n;
  const glm::dvec3 position =
      a + double{hit.point.weights.x} * (b - a) + double{hit.point.weights.y} * (c - a);
  const auto uv = [&](int i) { return glm::dvec2(coordinates(scene.scene.vertices[triangle.vertex[i]])); };
  const double uv_area2 = std::abs(cross(uv(1) - uv(0), uv(2) - uv(0)));
  Footprint footprint;
  footprint.uv = hit.distance * near_cone(options.rays) * std::sqrt(uv_area2 / area2);
  glm::dvec3 irradiance(0);
  for (const MappedLight& light : scene.lights) irradiance += direct_irradiance(light, position, n);
  if (options.reflects)
    irradiance += field_irradiance(basis, field_at(position, options.gather.gather_offset, n), n);
  const bool emitting = !back || double_sided(scene.scene.materials[triangle.material]);
  const glm::dvec3 emitted =
      emitting ? glm::dvec3(scene.materials.emissive(hit.point, footprint)) : glm::dvec3(0);
  return emitted + glm::dvec3(scene.materials.albedo(hit.point, footprint)) / std::numbers::pi * irradiance;
}

/// Orthonormal frame about the normal; near_layout.h names its source.
glm::dmat3 frame_about(const glm::dvec3& n) {
  const double sign = n.z < 0 ? -1 : 1, a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

void NearField::trace(NearPoint& point, const std::vector<glm::vec3>& directions) const {
  const double offset = options.gather.gather_offset;
  const RadianceField here = field_at(point.position, offset, point.normal);
  const double share = trust(here, point.normal);
  const glm::dmat3 frame = frame_about(point.normal);
  for (const glm::vec3& direction : directions) {
    const glm::dvec3 w = frame * glm::dvec3(direction);
    const NearRay ray{point.position + double{CLPV_NEAR_LIFT} * point.reach * point.normal, w, point.reach};
    const std::optional<NearHit> hit = nearest_triangle(scene.scene, scene.materials, ray, point.uncertain);
    const glm::dvec3 v = radiance(basis, here, -w);
    if (hit) {
      point.difference += radiance_of(*hit, point, w, point.uncertain) - v;
    } else {
      const glm::dvec3 end = point.position + point.reach * (offset * point.normal + w);
      point.difference += share * (radiance(basis, field_at(end, 0, point.normal), -w) - v);
    }
  }
  point.difference *= std::numbers::pi / static_cast<double>(directions.size());
}

/// Weight of a neighbour in a mean: 1 on the same surface, else 0.
double same_surface(const NearPoint& there, const glm::dvec3& position, const glm::dvec3& normal,
                    bool& uncertain) {
  if (there.reach == 0) return 0;
  const double cosine = glm::dot(normal, there.normal),
               off = std::abs(glm::dot(there.position - position, normal)) / there.reach;
  uncertain = uncertain || close_to(cosine, kSameNormal) || close_to(off, kSamePlane);
  return cosine > kSameNormal && off < kSamePlane ? 1 : 0;
}

/// Points of an image of the near field.
struct NearImage {
  int width, height;
  std::vector<NearPoint> points;

  const NearPoint& at(int x, int y) const {
    static const NearPoint none;
    return x < 0 || y < 0 || x >= width || y >= height ? none : points[y * width + x];
  }
};

/// Weighted mean of points.
struct Mean {
  glm::dvec3 total{0};
  double weight = 0;
  bool uncertain = false;

  void add(const NearPoint& there, double share, const glm::dvec3& position, const glm::dvec3& normal) {
    const double w = share * same_surface(there, position, normal, uncertain);
    total += w * there.difference;
    weight += w;
    uncertain = uncertain || (w > 0 && there.uncertain);
  }
  glm::dvec3 value() const { return weight > 0 ? total / weight : glm::dvec3(0); }
};

NearImage blurred(const NearImage& image) {
  NearImage result = image;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      NearPoint& point = result.points[y * image.width + x];
      Mean mean;
      for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
          const double share = (std::abs(dx) == 2 ? 0.5 : 1) * (std::abs(dy) == 2 ? 0.5 : 1);
          mean.add(image.at(x + dx, y + dy), share, point.position, point.normal);
        }
      }
      point.difference = mean.value();
      point.uncertain = mean.uncertain;
    }
  }
  return result;
}

NearImage widened(const NearImage& image) {
  NearImage result = image;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      NearPoint& point = result.points[y * image.width + x];
      Mean mean;
      for (const int dy : {-3, 0, 3}) {
        for (const int dx : {-3, 0, 3}) {
          const NearPoint& there = image.at(x + dx, y + dy);
          const double apart =
              point.reach > 0 ? glm::length(there.position - point.position) / point.reach : 0;
          mean.uncertain = mean.uncertain || close_to(apart, kWidened);
          mean.add(there, apart < kWidened ? 1 : 0, point.position, point.normal);
        }
      }
      point.difference = mean.value();
      point.uncertain = mean.uncertain;
    }
  }
  return result;
}

}  // namespace

std::optional<NearHit> nearest_triangle(const Scene& scene, const Materials& materials, const NearRay& ray,
                                        bool& uncertain) {
  std::optional<NearHit> nearest;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const auto [a, b, c] = corners_of(scene, scene.triangles[i]);
    const glm::dvec3 edge1 = b - a, edge2 = c - a, from = ray.from - a, across = glm::cross(ray.along, edge2),
                     around = glm::cross(from, edge1);
    const double scale = 1 / glm::dot(edge1, across);
    const double u = glm::dot(from, across) * scale, v = glm::dot(ray.along, around) * scale,
                 distance = glm::dot(edge2, around) * scale;
    const double inside = std::min({u, v, 1 - u - v});
    const double end = nearest ? nearest->distance : ray.reach;
    // Within the margin of the triangle, and not clearly beyond the end.
    const bool about =
        inside > -kNearEdge && distance > -kNearEdge * ray.reach && distance < end + kNearEdge * ray.reach;
    if (!about) continue;  // NaN for triangles without area, too
    const SurfacePoint point{i, {static_cast<float>(u), static_cast<float>(v)}};
    const double solidity = materials.solidity(point);
    if (solidity < -kAlphaTolerance) continue;
    uncertain = uncertain || inside < kNearEdge || distance < kNearEdge * ray.reach ||
                distance > end - kNearEdge * ray.reach || std::abs(solidity) < kAlphaTolerance;
    if (inside >= 0 && distance > 0 && distance < end && solidity >= 0) nearest = NearHit{point, distance};
  }
  return nearest;
}

NearResult near(const Basis& basis, const NearOptions& options, const NearScene& scene,
                const SurfaceImage& camera, const std::vector<glm::dvec3>& gathered) {
  const ClpvView& view = camera.view;
  const NearField field{basis, options, scene};
  const auto directions = near_directions(options.rays);
  const int step = options.step;
  NearImage image{(static_cast<int>(view.width) + step - 1) / step,
                  (static_cast<int>(view.height) + step - 1) / step,
                  {}};
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      NearPoint& point = image.points.emplace_back();
      const std::size_t pixel = std::size_t(step) * y * view.width + std::size_t(step) * x;
      if (camera.depth[pixel] <= 0) continue;
      point.position = surface_position(view, pixel, camera.depth[pixel]);
      point.normal = glm::dvec3(camera.normal[pixel]);
      point.reach = field.reach_at(point.position);
      if (point.reach > 0)
        field.trace(point, directions[y % CLPV_NEAR_TILE * CLPV_NEAR_TILE + x % CLPV_NEAR_TILE]);
    }
  }
  image = widened(blurred(image));
  NearResult result{gathered, std::vector<bool>(gathered.size(), false)};
  for (std::size_t pixel = 0; pixel < gathered.size(); ++pixel) {
    if (camera.depth[pixel] <= 0) continue;
    const int x = static_cast<int>(pixel % view.width), y = static_cast<int>(pixel / view.width);
    Mean mean;
    const glm::dvec3 position = surface_position(view, pixel, camera.depth[pixel]),
                     normal(camera.normal[pixel]);
    for (int corner = 0; corner < 4; ++corner) {
      const int right = corner % 2 * (x % step), below = corner / 2 * (y % step);
      mean.add(image.at(x / step + right, y / step + below), 1, position, normal);
    }
    result.irradiance[pixel] = glm::max(gathered[pixel] + mean.value(), 0.0);
    result.uncertain[pixel] = mean.uncertain;
  }
  return result;
}

}  // namespace clpv::reference
