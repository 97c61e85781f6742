// SPDX-License-Identifier: MIT
#include "reference/materials.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "reference/view.hpp"
#include "scene/mip_chain.hpp"

namespace clpv::reference {
namespace {

/// Base colour and alpha before any texture.
glm::vec4 untextured(const SceneData& scene, const SurfacePoint& point) {
  const Triangle& triangle = scene.triangles[point.triangle];
  const auto& factor = scene.materials[triangle.material].base_colour;
  return glm::vec4(factor[0], factor[1], factor[2], factor[3]) *
         interpolate(scene, triangle, point.weights, colour);
}

/// Linear values of all 8-bit sRGB values.
std::array<float, 256> decode_table() {
  std::array<float, 256> table{};
  for (unsigned i = 0; i < table.size(); ++i) table[i] = linear_from_srgb(i);
  return table;
}

/// Maps texel index `i` into [0, size) by wrap mode.
std::uint32_t wrap(std::int64_t i, std::uint32_t size, std::uint32_t mode) {
  const std::int64_t n = size;
  if (mode == CLPV_WRAP_CLAMP)
    return static_cast<std::uint32_t>(std::clamp<std::int64_t>(i, 0, n - 1));
  const std::int64_t period = mode == CLPV_WRAP_MIRROR ? 2 * n : n;
  std::int64_t j = i % period;
  if (j < 0) j += period;
  return j < n ? j : period - 1 - j;
}

glm::vec4 texel(const Texture& texture, std::uint32_t x, std::uint32_t y) {
  static const std::array<float, 256> decoded = decode_table();
  const std::uint8_t* rgba = &texture.rgba[4 * (static_cast<std::size_t>(y) * texture.width + x)];
  return {decoded[rgba[0]], decoded[rgba[1]], decoded[rgba[2]], rgba[3] / 255.0f};
}

/// log2(sqrt(square)), piecewise linear between powers of two of `square`; at least 0.
double mip_level(double square) {
  if (!(square < std::numeric_limits<double>::infinity()))
    return std::numeric_limits<double>::infinity();
  if (square <= 1) return 0;
  const int power = std::ilogb(square);
  return 0.5 * (power + std::ldexp(square, -power) - 1);
}

}  // namespace

Materials::Materials(const SceneData& scene) : scene_(&scene) {
  const std::vector<bool> holes = textures_with_holes(scene);
  for (std::size_t i = 0; i < holes.size(); ++i)
    textures_.push_back(mip_chain(scene.textures[i], holes[i]));
}

glm::vec3 Materials::albedo(const SurfacePoint& point, const Footprint& footprint) const {
  const ClpvMaterial& material = scene_->materials[scene_->triangles[point.triangle].material];
  return glm::vec3(untextured(*scene_, point)) * textured(material.texture, point, footprint);
}

glm::vec3 Materials::emissive(const SurfacePoint& point, const Footprint& footprint) const {
  const ClpvMaterial& material = scene_->materials[scene_->triangles[point.triangle].material];
  const glm::vec3 radiance{material.emissive[0], material.emissive[1], material.emissive[2]};
  if (radiance == glm::vec3(0)) return radiance;  // most materials: needs no texture
  return radiance * textured(material.emissive_texture, point, footprint);
}

float Materials::alpha(const SurfacePoint& point) const {
  const Triangle& triangle = scene_->triangles[point.triangle];
  const ClpvMaterial& material = scene_->materials[triangle.material];
  const float alpha = untextured(*scene_, point).a;
  if (material.texture == CLPV_NO_TEXTURE) return alpha;
  const glm::vec2 uv = interpolate(*scene_, triangle, point.weights, coordinates);
  return alpha * look_up(scene_->textures[material.texture], uv).a;
}

double Materials::solidity(const SurfacePoint& point) const {
  const ClpvMaterial& material = scene_->materials[scene_->triangles[point.triangle].material];
  if ((material.flags & CLPV_MATERIAL_MASKED) == 0) return 1;
  return double{alpha(point)} - double{material.alpha_cutoff};
}

bool Materials::hole(const SurfacePoint& point) const {
  return solidity(point) < 0;
}

/// Factor of the colour from a texture.
glm::vec3 Materials::textured(std::uint32_t texture, const SurfacePoint& point,
                              const Footprint& footprint) const {
  if (texture == CLPV_NO_TEXTURE) return glm::vec3(1);
  const Triangle& triangle = scene_->triangles[point.triangle];
  const glm::vec2 uv = interpolate(*scene_, triangle, point.weights, coordinates);
  if (footprint.uv > 0)
    return glm::vec3(look_up(textures_[texture], uv, {footprint.uv, 0}, {0, footprint.uv}));
  if (footprint.right == glm::dvec3(0) && footprint.below == glm::dvec3(0)) {
    return glm::vec3(look_up(scene_->textures[texture], uv));
  }
  return glm::vec3(look_up(textures_[texture], uv, texture_step(triangle, footprint.right),
                           texture_step(triangle, footprint.below)));
}

/// Change of (u, v) for a move of `step` [m] on the triangle's plane.
glm::dvec2 Materials::texture_step(const Triangle& triangle, const glm::dvec3& step) const {
  const Vertex &a = scene_->vertices[triangle.vertex[0]], &b = scene_->vertices[triangle.vertex[1]],
               &c = scene_->vertices[triangle.vertex[2]];
  const glm::dvec3 ab(position(b) - position(a)), ac(position(c) - position(a));
  const glm::dvec3 across = glm::cross(ab, ac);
  const double area2 = glm::dot(across, across);
  const double second = glm::dot(step, glm::cross(ac, across)) / area2;
  const double third = glm::dot(step, glm::cross(across, ab)) / area2;
  return second * glm::dvec2(coordinates(b) - coordinates(a)) +
         third * glm::dvec2(coordinates(c) - coordinates(a));
}

glm::vec4 look_up(const Texture& texture, const glm::vec2& uv) {
  // Beyond 2^24, float coordinates cannot distinguish adjacent texels, and the cast below would
  // overflow.
  constexpr float kMaxCoordinate = 16777216.0f;
  const glm::vec2 at = uv * glm::vec2(texture.width, texture.height) - 0.5f;
  if (!(std::abs(at.x) < kMaxCoordinate && std::abs(at.y) < kMaxCoordinate))
    return texel(texture, 0, 0);
  const glm::vec2 base = glm::floor(at), weight = at - base;
  const auto x = static_cast<std::int64_t>(base.x), y = static_cast<std::int64_t>(base.y);
  const std::uint32_t x0 = wrap(x, texture.width, texture.wrap_u),
                      x1 = wrap(x + 1, texture.width, texture.wrap_u);
  const std::uint32_t y0 = wrap(y, texture.height, texture.wrap_v),
                      y1 = wrap(y + 1, texture.height, texture.wrap_v);
  // Unlike glm::mix(), equal texels keep their value.
  const auto between = [](const glm::vec4& a, const glm::vec4& b, float t) {
    return a + t * (b - a);
  };
  return between(between(texel(texture, x0, y0), texel(texture, x1, y0), weight.x),
                 between(texel(texture, x0, y1), texel(texture, x1, y1), weight.x), weight.y);
}

glm::vec4 look_up(const std::vector<Texture>& levels, const glm::vec2& uv, const glm::dvec2& step_x,
                  const glm::dvec2& step_y) {
  const glm::dvec2 size(levels[0].width, levels[0].height);
  const glm::dvec2 x = step_x * size, y = step_y * size;  // [texels]
  const double coarsest = levels.size() - 1;
  const double level = std::min(mip_level(std::max(glm::dot(x, x), glm::dot(y, y))), coarsest);
  const std::size_t fine = level;
  const float weight = level - static_cast<double>(fine);
  const glm::vec4 colour = look_up(levels[fine], uv);
  return weight == 0 ? colour : glm::mix(colour, look_up(levels[fine + 1], uv), weight);
}

}  // namespace clpv::reference
