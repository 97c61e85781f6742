// SPDX-License-Identifier: MIT
// Builds and samples the distributions over emissive triangles and over the sky's texels.
#include "pathtracer/emitters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "basis/sampling.hpp"
#include "reference/view.hpp"
#include "scene/emission.hpp"

namespace clpv::pathtracer {
namespace {

constexpr int kEdgeSamples = 4;  // texture samples along a triangle's edge
// Share of the weight that ignores the texture, so that no texel has density 0.
constexpr double kWhiteShare = 0.1;

double brightest(const glm::dvec3& colour) {
  return std::max({colour.x, colour.y, colour.z, 0.0});
}

/// Approximate mean radiance of a triangle's front, in the brightest channel [W/m^2/sr].
double mean_radiance(const SceneData& scene, const reference::Materials& materials,
                     std::uint32_t triangle) {
  const ClpvMaterial& material = scene.materials[scene.triangles[triangle].material];
  const double white =
      brightest({material.emissive[0], material.emissive[1], material.emissive[2]});
  if (material.emissive_texture == CLPV_NO_TEXTURE) return white;
  const auto [a, b, c] = corners_of(scene, scene.triangles[triangle]);
  const reference::Footprint footprint{(b - a) / double{kEdgeSamples},
                                       (c - a) / double{kEdgeSamples}};
  double sum = 0;
  int samples = 0;
  for (int row = 0; row < kEdgeSamples; ++row) {
    for (int column = 0; column < kEdgeSamples - row; ++column, ++samples) {
      const glm::vec2 weights = (glm::vec2(column, row) + 1.0f / 3) / float{kEdgeSamples};
      sum += brightest(glm::dvec3(materials.emissive({triangle, weights}, footprint)));
    }
  }
  return (1 - kWhiteShare) * sum / samples + kWhiteShare * white;
}

}  // namespace

Emitters::Emitters(const SceneData& scene, const reference::Materials& materials)
    : scene_(scene), materials_(materials) {
  double total = 0;
  std::vector<double> areas;
  for (const std::uint32_t triangle : emissive_triangles(scene)) {
    const auto [a, b, c] = corners_of(scene, scene.triangles[triangle]);
    const double area = glm::length(glm::cross(b - a, c - a)) / 2;
    if (!(area > 0)) continue;
    const bool both = double_sided(scene.materials[scene.triangles[triangle].material]);
    total += area * mean_radiance(scene, materials, triangle) * (both ? 2 : 1);
    triangles_.push_back(triangle), areas.push_back(area), cdf_.push_back(total);
  }
  if (empty()) return;
  densities_.assign(scene.triangles.size(), 0);
  for (double& value : cdf_) value /= total;
  for (std::size_t i = 0; i < triangles_.size(); ++i)
    densities_[triangles_[i]] = (cdf_[i] - (i > 0 ? cdf_[i - 1] : 0)) / areas[i];
}

EmitterSample Emitters::sample(glm::dvec2 random) const {
  const auto [i, x] = sample_cdf(cdf_, random.x);
  // Map of the square (x, random.y) onto the triangle with constant density.
  const double root = std::sqrt(x), second = root * random.y, third = 1 - root;
  EmitterSample sample;
  sample.point = {triangles_[i], {static_cast<float>(second), static_cast<float>(third)}};
  const auto [a, b, c] = corners_of(scene_, scene_.triangles[triangles_[i]]);
  sample.position = glm::vec3(a + second * (b - a) + third * (c - a));
  sample.density = densities_[triangles_[i]];
  return sample;
}

glm::dvec3 Emitters::front_normal(std::uint32_t triangle) const {
  const auto [a, b, c] = corners_of(scene_, scene_.triangles[triangle]);
  return glm::normalize(glm::cross(b - a, c - a));
}

glm::dvec3 Emitters::radiance(const reference::SurfacePoint& point,
                              const glm::dvec3& towards) const {
  const ClpvMaterial& material = scene_.materials[scene_.triangles[point.triangle].material];
  if (!emits(material) ||
      (!double_sided(material) && glm::dot(front_normal(point.triangle), towards) <= 0))
    return glm::dvec3(0);
  return glm::dvec3(materials_.emissive(point));
}

namespace {

/// Divides cumulative sums by the last one, unless it is 0. Returns the last one.
double normalise(std::span<double> sums) {
  const double total = sums.back();
  if (total > 0) {
    for (double& sum : sums) sum /= total;
  }
  return total;
}

}  // namespace

double SkySampler::weight(std::size_t texel) const {
  const glm::vec3& radiance = sky_->texels[texel];
  return double{std::max({radiance.x, radiance.y, radiance.z})};
}

SkySampler::SkySampler(const Sky* sky) : sky_(sky) {
  if (sky == nullptr || !(sky->max_radiance() > 0)) return;
  const auto width = static_cast<std::size_t>(sky->width);
  for (int y = 0; y < sky->height; ++y) {
    const std::size_t first = column_cdfs_.size();
    double sum = 0;
    for (std::size_t x = 0; x < width; ++x) column_cdfs_.push_back(sum += weight(first + x));
    const double row = normalise(std::span(column_cdfs_).subspan(first));
    total_ += row * sky->solid_angle(y);
    row_cdf_.push_back(total_);
  }
  normalise(row_cdf_);
}

SkySample SkySampler::sample(const glm::dvec2& random) const {
  const auto width = static_cast<std::size_t>(sky_->width);
  const CdfSample row = sample_cdf(row_cdf_, random.y);
  const CdfSample column =
      sample_cdf(std::span(column_cdfs_).subspan(row.index * width, width), random.x);
  const double top = std::cos(std::numbers::pi * static_cast<double>(row.index) / sky_->height),
               bottom =
                   std::cos(std::numbers::pi * static_cast<double>(row.index + 1) / sky_->height);
  const double up = top + row.fraction * (bottom - top);  // uniform over the texel's solid angle
  const double y = std::acos(std::clamp(up, -1.0, 1.0)) / std::numbers::pi * sky_->height;
  const std::size_t texel = row.index * width + column.index;
  return {sky_->direction(static_cast<double>(column.index) + column.fraction, y),
          glm::dvec3(sky_->texels[texel]), weight(texel) / total_};
}

double SkySampler::density(const glm::dvec3& direction) const {
  return weight(sky_->texel_at(direction)) / total_;
}

}  // namespace clpv::pathtracer
