// SPDX-License-Identifier: MIT
// CPU reference of kernels/raster/texture.h: albedo, emission and alpha of a scene's surfaces,
// filtered like the rasteriser.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.hpp"

namespace clpv::reference {

/// A point on a triangle.
struct SurfacePoint {
  std::uint32_t triangle = 0;  ///< index in SceneData::triangles
  glm::vec2 weights{0};        ///< barycentric coordinates of the second and third vertex
};

/// Footprint of a pixel on a triangle's plane: offsets [m] to the next pixel on the right and
/// below. Zero: a point sample of the textures' finest level. Or a square in texture coordinates of
/// edge `uv`, if that is not 0.
struct Footprint {
  glm::dvec3 right{0}, below{0};
  double uv = 0;
};

/// Materials of a scene, which must outlive this object.
class Materials {
 public:
  explicit Materials(const SceneData& scene);

  /// Diffuse albedo: base colour x texture x vertex colour, linear.
  glm::vec3 albedo(const SurfacePoint& point, const Footprint& footprint = {}) const;
  /// Emitted radiance [W/m^2/sr].
  glm::vec3 emissive(const SurfacePoint& point, const Footprint& footprint = {}) const;
  /// Alpha: base colour x vertex x texture, from the texture's finest level.
  float alpha(const SurfacePoint& point) const;
  /// Alpha minus cutoff of a masked material, negative in holes; 1 for a material that is not
  /// masked.
  double solidity(const SurfacePoint& point) const;
  /// Returns true if a masked material has a hole at the point.
  bool hole(const SurfacePoint& point) const;

 private:
  glm::vec3 textured(std::uint32_t texture, const SurfacePoint& point,
                     const Footprint& footprint) const;
  glm::dvec2 texture_step(const Triangle& triangle, const glm::dvec3& step) const;

  const SceneData* scene_;
  std::vector<std::vector<Texture>> textures_;  // mip levels of each texture
};

/// Returns the texture at (u, v): linear RGB and alpha. Bilinear between four texels, each decoded
/// from sRGB before weighting; texel (0, 0) covers [0, 1/width] x [0, 1/height]. Non-finite
/// coordinates read texel (0, 0).
glm::vec4 look_up(const Texture& texture, const glm::vec2& uv);

/// Returns the texture at (u, v), interpolated between mip levels (mip_chain). The level is the
/// logarithm of the longer step in texels from pixel to pixel, approximated piecewise linearly as
/// in kernels/raster/texture.h. Steps that are not a number use the coarsest level.
glm::vec4 look_up(const std::vector<Texture>& levels, const glm::vec2& uv, const glm::dvec2& step_x,
                  const glm::dvec2& step_y);

}  // namespace clpv::reference
