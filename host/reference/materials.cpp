// SPDX-License-Identifier: MIT
#include "reference/materials.hpp"

#include <algorithm>
#include <cmath>

#include "reference/texture_lookup.hpp"
#include "reference/triangle.hpp"
#include "scene/mip_chain.hpp"
#include "support/error.hpp"

namespace clpv::reference {
namespace {

void check(const Scene& scene) {
  const auto finite = [](float v) { return std::isfinite(v); };
  const auto known = [&](std::uint32_t t) { return t == CLPV_NO_TEXTURE || t < scene.textures.size(); };
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    if (!std::ranges::all_of(m.base_colour, finite) || !std::ranges::all_of(m.emissive, finite) ||
        !finite(m.alpha_cutoff)) {
      throw Error(ExitCode::bad_input, "{}: material {}: a colour or alpha cutoff that is not finite",
                  scene.path, i);
    }
    if (!known(m.texture) || !known(m.emissive_texture)) {
      throw Error(ExitCode::bad_input, "{}: material {}: texture {} and {} of {}", scene.path, i, m.texture,
                  m.emissive_texture, scene.textures.size());
    }
  }
  for (const Texture& t : scene.textures) {
    if (t.width == 0 || t.height == 0 || t.rgba.size() != 4 * static_cast<std::size_t>(t.width) * t.height) {
      throw Error(ExitCode::bad_input, "{}: texture {}: {} bytes for {}x{} texels of 4", scene.path, t.name,
                  t.rgba.size(), t.width, t.height);
    }
  }
}

/// Colours of textures with holes are weighted by alpha, as on the device.
std::vector<std::vector<Texture>> mip_chains(const Scene& scene) {
  std::vector<bool> holes(scene.textures.size(), false);
  for (const Material& m : scene.materials) {
    if ((m.flags & CLPV_MATERIAL_MASKED) && m.texture != CLPV_NO_TEXTURE) holes[m.texture] = true;
  }
  std::vector<std::vector<Texture>> chains;
  for (std::size_t i = 0; i < holes.size(); ++i) chains.push_back(mip_chain(scene.textures[i], holes[i]));
  return chains;
}

/// Base colour and alpha before any texture.
glm::vec4 untextured(const Scene& scene, const SurfacePoint& point) {
  const Triangle& triangle = scene.triangles[point.triangle];
  const auto& factor = scene.materials[triangle.material].base_colour;
  return glm::vec4(factor[0], factor[1], factor[2], factor[3]) *
         interpolate(scene, triangle, point.weights, colour);
}

}  // namespace

Materials::Materials(const Scene& scene) : scene_(&scene) {
  check(scene);
  textures_ = mip_chains(scene);
}

glm::vec3 Materials::albedo(const SurfacePoint& point, const Footprint& footprint) const {
  const Material& material = scene_->materials[scene_->triangles[point.triangle].material];
  return glm::vec3(untextured(*scene_, point)) * textured(material.texture, point, footprint);
}

glm::vec3 Materials::emissive(const SurfacePoint& point, const Footprint& footprint) const {
  const Material& material = scene_->materials[scene_->triangles[point.triangle].material];
  const glm::vec3 radiance{material.emissive[0], material.emissive[1], material.emissive[2]};
  if (radiance == glm::vec3(0)) return radiance;  // most materials: spares them the look at a texture
  return radiance * textured(material.emissive_texture, point, footprint);
}

float Materials::alpha(const SurfacePoint& point) const {
  const Triangle& triangle = scene_->triangles[point.triangle];
  const Material& material = scene_->materials[triangle.material];
  const float alpha = untextured(*scene_, point).a;
  if (material.texture == CLPV_NO_TEXTURE) return alpha;
  const glm::vec2 uv = interpolate(*scene_, triangle, point.weights, coordinates);
  return alpha * look_up(scene_->textures[material.texture], uv).a;
}

bool Materials::hole(const SurfacePoint& point) const {
  return alpha(point) < scene_->materials[scene_->triangles[point.triangle].material].alpha_cutoff;
}

/// What a texture multiplies the colour with.
glm::vec3 Materials::textured(std::uint32_t texture, const SurfacePoint& point,
                              const Footprint& footprint) const {
  if (texture == CLPV_NO_TEXTURE) return glm::vec3(1);
  const Triangle& triangle = scene_->triangles[point.triangle];
  const glm::vec2 uv = interpolate(*scene_, triangle, point.weights, coordinates);
  if (footprint.right == glm::dvec3(0) && footprint.below == glm::dvec3(0)) {
    return glm::vec3(look_up(scene_->textures[texture], uv));
  }
  return glm::vec3(look_up(textures_[texture], uv, texture_step(triangle, footprint.right),
                           texture_step(triangle, footprint.below)));
}

/// How far (u, v) of the texture moves when the point moves by `step` [m] on the triangle's plane.
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

}  // namespace clpv::reference
