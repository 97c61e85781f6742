// SPDX-License-Identifier: MIT
// The colours of a scene's surfaces on the host: factors, vertex colours and textures, filtered as the
// rasteriser does.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.hpp"

namespace clpv::reference {

/// A point on a triangle.
struct SurfacePoint {
  std::uint32_t triangle = 0;  ///< index in Scene::triangles
  glm::vec2 weights{0};        ///< of its second and third vertex
};

/// How far a surface point moves on its triangle's plane [m] from a pixel to the next one right, and the next
/// below. Zero: a look at a single point, which textures answer from their finest level.
struct Footprint {
  glm::dvec3 right{0}, below{0};
};

/// Borrows the scene: it must outlive this.
class Materials {
 public:
  explicit Materials(const Scene& scene);

  /// Diffuse albedo: base colour x texture x vertex colour, linear.
  glm::vec3 albedo(const SurfacePoint& point, const Footprint& footprint = {}) const;
  /// Emitted radiance [W/m^2/sr].
  glm::vec3 emissive(const SurfacePoint& point, const Footprint& footprint = {}) const;
  /// Base colour's alpha x vertex's x texture's, from the texture's finest level.
  float alpha(const SurfacePoint& point) const;
  /// How far alpha is above the cutoff of a masked material, below 0 in its holes; 1 for a material that is not masked.
  double solidity(const SurfacePoint& point) const;
  /// Whether a masked material has a hole here.
  bool hole(const SurfacePoint& point) const;

 private:
  glm::vec3 textured(std::uint32_t texture, const SurfacePoint& point, const Footprint& footprint) const;
  glm::dvec2 texture_step(const Triangle& triangle, const glm::dvec3& step) const;

  const Scene* scene_;
  std::vector<std::vector<Texture>> textures_;  // mip levels of each
};

/// The texture at (u, v): linear RGB and alpha. Bilinear between the four texels round it, each decoded from
/// sRGB before it is weighted; texel (0, 0) fills [0, 1/width] x [0, 1/height]. Non-finite coordinates read
/// texel (0, 0).
glm::vec4 look_up(const Texture& texture, const glm::vec2& uv);

/// The same between the two mip levels (mip_chain) whose texels are about as large as the longer of the two
/// steps in (u, v) from pixel to pixel, as the rasteriser filters (kernels/texture.h: the level is log2 of the
/// step, drawn as straight lines). Steps that are no number take the coarsest level.
glm::vec4 look_up(const std::vector<Texture>& levels, const glm::vec2& uv, const glm::dvec2& step_x,
                  const glm::dvec2& step_y);

}  // namespace clpv::reference
