// SPDX-License-Identifier: MIT
#include "pathtracer/emitters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "pathtracer/sampling.hpp"
#include "reference/triangle.hpp"
#include "scene/emission.hpp"

namespace clpv::reference {
namespace {

constexpr int kLooks = 4;           // along a triangle's edge, at its texture
constexpr double kLeastMean = 0.1;  // of a texture as white: what looks missed is picked all the same

double brightest(const glm::dvec3& colour) {
  return std::max({colour.x, colour.y, colour.z, 0.0});
}

/// About what a triangle's front sends out of each square metre, in the brightest channel.
double emitted(const Scene& scene, const Materials& materials, std::uint32_t triangle) {
  const Material& material = scene.materials[scene.triangles[triangle].material];
  const double white = brightest({material.emissive[0], material.emissive[1], material.emissive[2]});
  if (material.emissive_texture == CLPV_NO_TEXTURE) return white;
  const auto [a, b, c] = corners_of(scene, scene.triangles[triangle]);
  const Footprint around{(b - a) / double{kLooks}, (c - a) / double{kLooks}};
  double sum = 0;
  int looks = 0;
  for (int row = 0; row < kLooks; ++row) {
    for (int column = 0; column < kLooks - row; ++column, ++looks) {
      const glm::vec2 weights = (glm::vec2(column, row) + 1.0f / 3) / float{kLooks};
      sum += brightest(glm::dvec3(materials.emissive({triangle, weights}, around)));
    }
  }
  return (1 - kLeastMean) * sum / looks + kLeastMean * white;
}

}  // namespace

Emitters::Emitters(const Scene& scene, const Materials& materials) : scene_(scene), materials_(materials) {
  double total = 0;
  std::vector<double> areas;
  for (const std::uint32_t triangle : emissive_triangles(scene)) {
    const auto [a, b, c] = corners_of(scene, scene.triangles[triangle]);
    const double area = glm::length(glm::cross(b - a, c - a)) / 2;
    if (!(area > 0)) continue;
    const bool both = double_sided(scene.materials[scene.triangles[triangle].material]);
    total += area * emitted(scene, materials, triangle) * (both ? 2 : 1);
    triangles_.push_back(triangle), areas.push_back(area), upto_.push_back(total);
  }
  if (none()) return;
  densities_.assign(scene.triangles.size(), 0);
  for (double& share : upto_) share /= total;
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    densities_[triangles_[i]] = (upto_[i] - (i > 0 ? upto_[i - 1] : 0)) / areas[i];
}

EmitterPoint Emitters::pick(glm::dvec2 at) const {
  const auto [i, x] = find_share(upto_, at.x);  // x: even again within its share
  // The square folded onto the triangle.
  const double root = std::sqrt(x), second = root * at.y, third = 1 - root;
  EmitterPoint point;
  point.point = {triangles_[i], {static_cast<float>(second), static_cast<float>(third)}};
  const auto [a, b, c] = corners_of(scene_, scene_.triangles[triangles_[i]]);
  point.position = glm::vec3(a + second * (b - a) + third * (c - a));
  point.density = densities_[triangles_[i]];
  return point;
}

glm::dvec3 Emitters::front(std::uint32_t triangle) const {
  const auto [a, b, c] = corners_of(scene_, scene_.triangles[triangle]);
  return glm::normalize(glm::cross(b - a, c - a));
}

glm::dvec3 Emitters::radiance(const SurfacePoint& point, const glm::dvec3& towards) const {
  const Material& material = scene_.materials[scene_.triangles[point.triangle].material];
  if (!emits(material) || (!double_sided(material) && glm::dot(front(point.triangle), towards) <= 0))
    return glm::dvec3(0);
  return glm::dvec3(materials_.emissive(point));
}

namespace {

/// Makes sums shares of the last one, which is returned.
double to_shares(std::span<double> sums) {
  const double all = sums.back();
  if (all > 0) {
    for (double& sum : sums) sum /= all;
  }
  return all;
}

}  // namespace

double SkySampler::weight(std::size_t texel) const {
  const glm::vec3& radiance = sky_->texels[texel];
  return double{std::max({radiance.x, radiance.y, radiance.z})};
}

SkySampler::SkySampler(const Sky* sky) : sky_(sky) {
  if (sky == nullptr || !(sky->brightest() > 0)) return;
  const auto width = static_cast<std::size_t>(sky->width);
  for (int y = 0; y < sky->height; ++y) {
    const std::size_t first = upto_column_.size();
    double sum = 0;
    for (std::size_t x = 0; x < width; ++x) upto_column_.push_back(sum += weight(first + x));
    const double row = to_shares(std::span(upto_column_).subspan(first));
    all_ += row * sky->solid_angle(y);
    upto_row_.push_back(all_);
  }
  to_shares(upto_row_);
}

SkyDirection SkySampler::pick(const glm::dvec2& at) const {
  const auto width = static_cast<std::size_t>(sky_->width);
  const ShareIn row = find_share(upto_row_, at.y);
  const ShareIn column = find_share(std::span(upto_column_).subspan(row.index * width, width), at.x);
  const double top = std::cos(std::numbers::pi * static_cast<double>(row.index) / sky_->height),
               bottom = std::cos(std::numbers::pi * static_cast<double>(row.index + 1) / sky_->height);
  const double up = top + row.within * (bottom - top);  // even over the texel's solid angle
  const double y = std::acos(std::clamp(up, -1.0, 1.0)) / std::numbers::pi * sky_->height;
  const std::size_t texel = row.index * width + column.index;
  return {sky_->direction(static_cast<double>(column.index) + column.within, y),
          glm::dvec3(sky_->texels[texel]), weight(texel) / all_};
}

double SkySampler::density(const glm::dvec3& direction) const {
  return weight(sky_->texel_at(direction)) / all_;
}

}  // namespace clpv::reference
