// SPDX-License-Identifier: MIT
#include "pathtracer/emitters.hpp"

#include <algorithm>
#include <cmath>

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

struct Corners {
  glm::dvec3 first, to_second, to_third;
};

Corners corners_of(const Scene& scene, std::uint32_t triangle) {
  const auto& vertex = scene.triangles[triangle].vertex;
  const glm::dvec3 first(position(scene.vertices[vertex[0]]));
  return {first, glm::dvec3(position(scene.vertices[vertex[1]])) - first,
          glm::dvec3(position(scene.vertices[vertex[2]])) - first};
}

/// About what a triangle's front sends out of each square metre, in the brightest channel.
double emitted(const Scene& scene, const Materials& materials, std::uint32_t triangle) {
  const Material& material = scene.materials[scene.triangles[triangle].material];
  const double white = brightest({material.emissive[0], material.emissive[1], material.emissive[2]});
  if (material.emissive_texture == CLPV_NO_TEXTURE) return white;
  const Corners c = corners_of(scene, triangle);
  const Footprint around{c.to_second / double{kLooks}, c.to_third / double{kLooks}};
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
    const Corners c = corners_of(scene, triangle);
    const double area = glm::length(glm::cross(c.to_second, c.to_third)) / 2;
    if (!(area > 0)) continue;
    const bool both = scene.materials[scene.triangles[triangle].material].flags & CLPV_MATERIAL_DOUBLE_SIDED;
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
  const Corners c = corners_of(scene_, triangles_[i]);
  point.position = glm::vec3(c.first + second * c.to_second + third * c.to_third);
  point.density = densities_[triangles_[i]];
  return point;
}

glm::dvec3 Emitters::front(std::uint32_t triangle) const {
  const Corners c = corners_of(scene_, triangle);
  return glm::normalize(glm::cross(c.to_second, c.to_third));
}

glm::dvec3 Emitters::radiance(const SurfacePoint& point, const glm::dvec3& towards) const {
  const Material& material = scene_.materials[scene_.triangles[point.triangle].material];
  const bool both = material.flags & CLPV_MATERIAL_DOUBLE_SIDED;
  if (!emits(material) || (!both && glm::dot(front(point.triangle), towards) <= 0)) return glm::dvec3(0);
  return glm::dvec3(materials_.emissive(point));
}

}  // namespace clpv::reference
