// SPDX-License-Identifier: MIT
#include "reference/near.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "basis/bounce.hpp"
#include "basis/sampling.hpp"
#include "kernels/shared/near.h"
#include "kernels/shared/pixel_planes.h"
#include "reference/cascade_sample.hpp"
#include "reference/view.hpp"

namespace clpv::reference {
namespace {

constexpr double kSameNormal = 0.7, kSamePlane = 0.1;                        // near_surface.h
constexpr double kWidened = 0.2, kDark = 0.25;                               // near_filter.cl
constexpr double kLeastArriving = 0.5, kEndLift = 0.15, kMiddleLift = 0.22;  // near.cl

bool close_to(double value, double limit) {
  return std::abs(value - limit) < kNearEdge * std::max(1.0, std::abs(limit));
}

/// A traced pixel.
struct NearPoint {
  glm::dvec3 position{0}, normal{0}, lift{0}, clear{0};
  double reach = 0;  ///< [m]; 0 without a surface in a cascade
  glm::dvec3 difference{0}, gathered{0};
  bool uncertain = false;  ///< light
  bool unknown = false;    ///< the pixel itself
};

struct NearField {
  const Basis& basis;
  const NearOptions& options;
  const NearScene& scene;

  double reach_at(const glm::dvec3& position) const;
  RadianceField field_at(const glm::dvec3& position, double offset, const glm::dvec3& lift,
                         const ClearWay& clear = {}) const {
    return radiance_field(options.gather, scene.cascades, basis.size(), position, offset, lift,
                          clear);
  }
  bool unsure(const glm::dvec3& position, double offset, const glm::dvec3& lift,
              const ClearWay& clear) const {
    return rounding_decides(options.gather, scene.cascades, position, offset, lift, clear);
  }
  bool in_sight(NearPoint& point, const glm::dvec3& off) const;
  double trust(const RadianceField& field, const glm::dvec3& normal) const;
  glm::dvec3 radiance_of(const NearHit& hit, const NearPoint& point, const glm::dvec3& along,
                         bool& uncertain) const;
  void trace(NearPoint& point, const std::vector<glm::vec3>& directions) const;
};

double NearField::reach_at(const glm::dvec3& position) const {
  double reach = 0, rest = 1;
  for (const Cascade& cascade : scene.cascades) {
    const double share =
        share_of(position, cascade.grid, options.gather.grid, options.gather.blend_cells);
    reach += share * rest * double{cascade.grid.cell};
    rest *= 1 - share;
  }
  return reach;
}

/// Whether the place at `off` from a point sees a cell that the point towards the eye sees, in the
/// finest cascade that lights it.
bool NearField::in_sight(NearPoint& point, const glm::dvec3& off) const {
  if (options.gather.gather != Gathering::visible || point.clear == glm::dvec3(0)) return true;
  const double reach = 1.0001 * point.reach;
  std::size_t c = 0;
  while (c + 1 < scene.cascades.size() && double{scene.cascades[c + 1].grid.cell} <= reach) ++c;
  for (const Cascade& each : scene.cascades)
    point.uncertain = point.uncertain || std::abs(reach / double{each.grid.cell} - 1) < 1e-5;
  const Cascade& cascade = scene.cascades[c];
  const double cell = cascade.grid.cell;
  const auto in_cells = [&](const glm::dvec3& way) {
    const glm::dvec3 at = (point.position + way - vector(cascade.grid.origin)) / cell - 0.5;
    point.uncertain = point.uncertain || rounding_decides(at, options.gather.grid);
    return at;
  };
  const double far = glm::length(point.clear);
  return see_a_cell(in_cells(point.clear * std::min(1.0, 0.85 * point.reach / far)), in_cells(off),
                    options.gather.grid, cascade.occluded);
}

double sum(const glm::dvec3& v) {
  return v.x + v.y + v.z;
}

/// Weight of the correction for rays that miss.
double NearField::trust(const RadianceField& field, const glm::dvec3& normal) const {
  const double arriving = sum(glm::dvec3(raw_irradiance(basis, field, normal))),
               leaving = sum(glm::dvec3(raw_irradiance(basis, field, -normal)));
  return arriving >= kLeastArriving * leaving ? 1 : arriving / (kLeastArriving * leaving);
}

/// Radiance of a hit towards the ray's origin.
glm::dvec3 NearField::radiance_of(const NearHit& hit, const NearPoint& point,
                                  const glm::dvec3& along, bool& uncertain) const {
  const Triangle& triangle = scene.scene.triangles[hit.point.triangle];
  const auto [a, b, c] = corners_of(scene.scene, triangle);
  const glm::dvec3 across = glm::cross(b - a, c - a);
  const double area2 = glm::length(across);
  const double height = std::abs(glm::dot(point.position - a, across)) / (area2 * point.reach);
  uncertain =
      uncertain || std::abs(height - 2 * double{CLPV_NEAR_LIFT}) < 0.1 * double{CLPV_NEAR_LIFT};
  if (height <= 2 * double{CLPV_NEAR_LIFT}) return glm::dvec3(0);
  const bool back = glm::dot(across, along) > 0;
  const glm::dvec3 front = back ? -across : across;
  glm::dvec3 n(interpolate(scene.scene, triangle, hit.point.weights, normal));
  if (glm::dot(n, n) == 0) n = front;
  n = glm::normalize(n);
  if (glm::dot(n, front) < 0) n = -n;
  const glm::dvec3 position =
      a + double{hit.point.weights.x} * (b - a) + double{hit.point.weights.y} * (c - a);
  const auto uv = [&](int i) {
    return glm::dvec2(coordinates(scene.scene.vertices[triangle.vertex[i]]));
  };
  const double uv_area2 = std::abs(cross(uv(1) - uv(0), uv(2) - uv(0)));
  Footprint footprint;
  footprint.uv = hit.distance * near_cone(options.rays) * std::sqrt(uv_area2 / area2);
  glm::dvec3 irradiance(0);
  const glm::dvec3 geometric = glm::normalize(front);
  for (const MappedLight& light : scene.lights)
    irradiance += direct_irradiance(light, position, n, geometric);
  if (options.reflects) {
    const double offset = options.gather.gather_offset, far = glm::length(point.clear);
    const glm::dvec3 lift = lift_normal(n, geometric),
                     seen = point.position + point.clear * std::min(1.0, point.reach / far),
                     clear = far > 0 ? seen - position : glm::dvec3(0);
    irradiance += field_irradiance(basis, field_at(position, offset, lift, clear), n);
    uncertain = uncertain || unsure(position, offset, lift, clear);
  }
  const bool emitting = !back || double_sided(scene.scene.materials[triangle.material]);
  const glm::dvec3 emitted =
      emitting ? glm::dvec3(scene.materials.emissive(hit.point, footprint)) : glm::dvec3(0);
  return emitted +
         glm::dvec3(scene.materials.albedo(hit.point, footprint)) / std::numbers::pi * irradiance;
}

/// Orthonormal frame about the normal; near_layout.h names its source.
glm::dmat3 frame_about(const glm::dvec3& n) {
  const double sign = n.z < 0 ? -1 : 1, a = -1 / (sign + n.z), b = n.x * n.y * a;
  return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

void NearField::trace(NearPoint& point, const std::vector<glm::vec3>& directions) const {
  const double offset = options.gather.gather_offset;
  const RadianceField here = field_at(point.position, offset, point.lift, point.clear);
  point.gathered = field_irradiance(basis, here, point.normal);
  const double share = trust(here, point.normal);
  // At the pixel all directions share the denominator of its irradiance.
  const double white = over_furnace(raw_irradiance(basis, here, point.normal).w / std::numbers::pi);
  const glm::dmat3 frame = frame_about(point.normal);
  for (const glm::vec3& direction : directions) {
    const glm::dvec3 w = frame * glm::dvec3(direction);
    const NearRay ray{point.position + double{CLPV_NEAR_LIFT} * point.reach * point.lift, w,
                      point.reach};
    const std::optional<NearHit> hit =
        nearest_triangle(scene.scene, scene.materials, ray, point.uncertain);
    std::vector<double> y(static_cast<std::size_t>(basis.size()));
    basis.evaluate(-w, y);
    const glm::dvec3 v = glm::dvec3(dot(y, here[0]), dot(y, here[1]), dot(y, here[2])) / white;
    if (hit) {
      point.difference += radiance_of(*hit, point, w, point.uncertain) - v;
    } else {
      const glm::dvec3 middle = w / 2.0 + kMiddleLift * point.lift;
      const bool open = share == 0 || in_sight(point, point.reach * middle);
      const glm::dvec3 way = open ? w + kEndLift * point.lift : w,
                       end = point.position + point.reach * way;
      const ClearWay clear(point.reach * ((open ? middle : w / 2.0) - way), point.clear);
      point.difference += share * (radiance(basis, field_at(end, 0, point.normal, clear), -w) - v);
      point.uncertain = point.uncertain || (share > 0 && unsure(end, 0, point.normal, clear));
    }
  }
  point.difference *= std::numbers::pi / static_cast<double>(directions.size());
}

/// Weight of a near pixel in a mean: 1 on the same surface, else 0.
double same_surface(const NearPoint& there, const glm::dvec3& position, const glm::dvec3& normal,
                    bool& uncertain) {
  uncertain = uncertain || there.unknown;
  if (there.reach == 0) return 0;
  const double cosine = glm::dot(normal, there.normal),
               off = std::abs(glm::dot(there.position - position, normal)) / there.reach;
  uncertain = uncertain || close_to(cosine, kSameNormal) || close_to(off, kSamePlane);
  return cosine > kSameNormal && off < kSamePlane ? 1 : 0;
}

/// Pixels of the near field: two layers, the second empty with step 1 (near_layout.h).
struct NearImage {
  int width, height;
  std::array<std::vector<NearPoint>, 2> layers;

  const NearPoint& at(int layer, int x, int y) const {
    static const NearPoint none;
    const bool inside = x >= 0 && y >= 0 && x < width && y < height && !layers[layer].empty();
    return inside ? layers[layer][y * width + x] : none;
  }
};

/// Weighted mean of points.
struct Mean {
  glm::dvec3 difference{0}, gathered{0};
  double weight = 0;
  bool uncertain = false;

  void add(const NearPoint& there, double share, const glm::dvec3& position,
           const glm::dvec3& normal) {
    if (share > 0) add(there, share * same_surface(there, position, normal, uncertain));
  }
  void add(const NearPoint& there, double w) {
    difference += w * there.difference;
    gathered += w * there.gathered;
    weight += w;
    uncertain = uncertain || (w > 0 && there.uncertain);
  }
  void put(NearPoint& point) const {
    point.difference = weight > 0 ? difference / weight : glm::dvec3(0);
    point.gathered = weight > 0 ? gathered / weight : glm::dvec3(0);
    point.uncertain = uncertain;
  }
};

double darkened(double left) {
  return left > kDark ? left : kDark * kDark / (2 * kDark - left);
}

/// Replaces the light of all points by `mean(layer, x, y, point)`.
template <typename MeanOf>
NearImage filtered(const NearImage& image, const MeanOf& mean) {
  NearImage result = image;
  for (int layer = 0; layer < 2; ++layer) {
    for (int i = 0; i < static_cast<int>(result.layers[layer].size()); ++i) {
      NearPoint& point = result.layers[layer][i];
      mean(layer, i % image.width, i / image.width, point).put(point);
    }
  }
  return result;
}

NearImage blurred(const NearImage& image) {
  return filtered(image, [&](int layer, int x, int y, const NearPoint& point) {
    Mean mean;
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const double share = (std::abs(dx) == 2 ? 0.5 : 1) * (std::abs(dy) == 2 ? 0.5 : 1);
        mean.add(image.at(layer, x + dx, y + dy), share, point.position, point.normal);
      }
    }
    return mean;
  });
}

NearImage widened(const NearImage& image) {
  return filtered(image, [&](int layer, int x, int y, const NearPoint& point) {
    Mean mean;
    for (const int dy : {-3, 0, 3}) {
      for (const int dx : {-3, 0, 3}) {
        const NearPoint& there = image.at(layer, x + dx, y + dy);
        const double apart =
            point.reach > 0 ? glm::length(there.position - point.position) / point.reach : 0;
        mean.uncertain = mean.uncertain || close_to(apart, kWidened);
        mean.add(there, apart < kWidened ? 1 : 0, point.position, point.normal);
      }
    }
    return mean;
  });
}

/// The near field's pixels of a camera's image.
struct NearPixels {
  const NearField& field;
  const SurfaceImage& camera;
  int step;

  NearPoint point_at(int x, int y) const {
    NearPoint point;
    const std::size_t pixel = std::size_t{camera.view.width} * y + x;
    if (camera.depth[pixel] <= 0) return point;
    point.position = surface_position(camera.view, pixel, camera.depth[pixel]);
    point.normal = glm::dvec3(camera.normal[pixel]);
    point.lift = lift_normal(camera.normal[pixel]);
    point.clear = towards_eye(camera.view, point.position);
    point.reach = field.reach_at(point.position);
    point.uncertain =
        field.unsure(point.position, field.options.gather.gather_offset, point.lift, point.clear);
    return point;
  }

  /// Light at a pixel of the camera from near pixels on its surface: bilinear; if there is none, a
  /// mean over the blocks around, on its surface or, failing that, on any.
  Mean interpolated(const NearImage& image, int x, int y) const {
    const NearPoint here = point_at(x, y);
    const double across = x % step / double(step), down = y % step / double(step);
    Mean mean;
    for (int layer = 0; layer < 2; ++layer) {
      for (int corner = 0; corner < 4; ++corner) {
        const int right = corner % 2, below = corner / 2;
        mean.add(image.at(layer, x / step + right, y / step + below),
                 (right ? across : 1 - across) * (below ? down : 1 - down), here.position,
                 here.normal);
      }
    }
    for (const bool any : {false, true}) {
      if (mean.weight > 0 || step == 1) return mean;
      for (int layer = 0; layer < 2; ++layer) {
        for (int dy = -1; dy <= 2; ++dy) {
          for (int dx = -1; dx <= 2; ++dx) {
            const NearPoint& there = image.at(layer, x / step + dx, y / step + dy);
            if (any)
              mean.add(there, there.reach > 0 ? 1 : 0);
            else
              mean.add(there, 1, here.position, here.normal);
          }
        }
      }
    }
    return mean;
  }

  /// The first pixel of a block whose surface no near pixel of the blocks around it has.
  NearPoint other(const NearImage& image, int block_x, int block_y) const {
    bool unknown = false;
    for (int y = block_y * step; y < std::min(block_y * step + step, int(camera.view.height));
         ++y) {
      for (int x = block_x * step; x < std::min(block_x * step + step, int(camera.view.width));
           ++x) {
        NearPoint point = point_at(x, y);
        if (camera.depth[std::size_t{camera.view.width} * y + x] <= 0) continue;
        double covered = 0;
        for (int dy = -1; dy <= 2; ++dy) {
          for (int dx = -1; dx <= 2; ++dx)
            covered += same_surface(image.at(0, block_x + dx, block_y + dy), point.position,
                                    point.normal, unknown);
        }
        if (covered > 0) continue;
        point.unknown = unknown;
        return point;
      }
    }
    NearPoint none;
    none.unknown = unknown;
    return none;
  }
};

}  // namespace

std::optional<NearHit> nearest_triangle(const SceneData& scene, const Materials& materials,
                                        const NearRay& ray, bool& uncertain) {
  std::optional<NearHit> nearest;
  for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const auto [a, b, c] = corners_of(scene, scene.triangles[i]);
    const glm::dvec3 edge1 = b - a, edge2 = c - a, from = ray.from - a,
                     across = glm::cross(ray.along, edge2), around = glm::cross(from, edge1);
    const double scale = 1 / glm::dot(edge1, across);
    const double u = glm::dot(from, across) * scale, v = glm::dot(ray.along, around) * scale,
                 distance = glm::dot(edge2, around) * scale;
    const double inside = std::min({u, v, 1 - u - v});
    const double end = nearest ? nearest->distance : ray.reach;
    // Within the margin of the triangle, and not clearly beyond the end.
    const bool about = inside > -kNearEdge && distance > -kNearEdge * ray.reach &&
                       distance < end + kNearEdge * ray.reach;
    if (!about) continue;  // NaN for triangles without area, too
    const SurfacePoint point{i, {static_cast<float>(u), static_cast<float>(v)}};
    const double solidity = materials.solidity(point);
    if (solidity < -kAlphaTolerance) continue;
    uncertain = uncertain || inside < kNearEdge || distance < kNearEdge * ray.reach ||
                distance > end - kNearEdge * ray.reach || std::abs(solidity) < kAlphaTolerance;
    if (inside >= 0 && distance > 0 && distance < end && solidity >= 0)
      nearest = NearHit{point, distance};
  }
  return nearest;
}

NearResult near(const Basis& basis, const NearOptions& options, const NearScene& scene,
                const SurfaceImage& camera, const std::vector<glm::dvec3>& gathered) {
  const ClpvView& view = camera.view;
  const NearField field{basis, options, scene};
  const auto directions = near_directions(options.rays);
  const int step = options.step;
  const NearPixels pixels{field, camera, step};
  NearImage image{(static_cast<int>(view.width) + step - 1) / step,
                  (static_cast<int>(view.height) + step - 1) / step,
                  {}};
  for (int layer = 0; layer < (step > 1 ? 2 : 1); ++layer) {
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        NearPoint point =
            layer == 0 ? pixels.point_at(step * x, step * y) : pixels.other(image, x, y);
        if (point.reach > 0)
          field.trace(point,
                      directions[y % CLPV_PLANE_TILE * CLPV_PLANE_TILE + x % CLPV_PLANE_TILE]);
        image.layers[layer].push_back(point);
      }
    }
  }
  image = widened(blurred(image));
  NearResult result{gathered, std::vector<bool>(gathered.size(), false)};
  for (std::size_t pixel = 0; pixel < gathered.size(); ++pixel) {
    if (camera.depth[pixel] <= 0) continue;
    const int x = static_cast<int>(pixel % view.width), y = static_cast<int>(pixel / view.width);
    const Mean sums = pixels.interpolated(image, x, y);
    result.uncertain[pixel] = sums.uncertain || pixels.point_at(x, y).uncertain;
    NearPoint mean;
    sums.put(mean);
    for (int channel = 0; channel < 3; ++channel) {
      const double difference = mean.difference[channel], all = mean.gathered[channel];
      if (difference < 0 && all > 0)
        result.irradiance[pixel][channel] *= darkened((all + difference) / all);
      else
        result.irradiance[pixel][channel] += std::max(difference, 0.0);
    }
  }
  return result;
}

}  // namespace clpv::reference
