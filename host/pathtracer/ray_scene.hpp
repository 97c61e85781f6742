// SPDX-License-Identifier: MIT
// Ray queries in a scene: Embree in its robust mode, with alpha masks and back-face culling.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "kernels/shared/view.h"
#include "reference/materials.hpp"
#include "scene/scene.hpp"
#include "support/error.hpp"

namespace clpv::pathtracer {

/// Intersection of a ray with a surface.
struct Hit {
  float distance = 0;  ///< in lengths of the ray's direction
  glm::vec3 position{
      0};  ///< [m], interpolated from the vertices: more precise than origin + distance * direction
  glm::vec3 geometric{0};  ///< unit normal of the triangle, on the side of the ray's origin
  glm::vec3 normal{0};  ///< unit normal interpolated from the vertices, on the side of `geometric`
  reference::SurfacePoint point;  ///< the position in barycentric coordinates
};

/// Footprint on the surface of the pixel (px, py) with primary hit `hit`, whose `distance` is the
/// depth.
reference::Footprint footprint(const ClpvView& view, unsigned px, unsigned py, const Hit& hit);

/// Faces that a ray can hit.
enum class Faces {
  culled,  ///< front faces, and back faces of double-sided materials, as rasterised for a camera
  all,     ///< front and back faces, as rasterised for a light
};

/// Throws Error(code) in a build without Embree (CLPV_PATHTRACER=OFF), which has no RayScene.
void require_rays(ExitCode code);

/// Acceleration structure of a scene. Borrows the scene. Queries are thread-safe.
class RayScene {
 public:
  /// Throws Error(bad_input) for a scene without triangles, Error(run_time) if Embree fails (out of
  /// memory) or is missing.
  explicit RayScene(const SceneData& scene);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  const reference::Materials& materials() const;

  /// The nearest surface at origin + t direction, t in (nearest, furthest), without holes of masked
  /// materials.
  std::optional<Hit> intersect(const glm::vec3& origin, const glm::vec3& direction, float nearest,
                               float furthest, Faces faces) const;

  /// Returns true if a surface, front or back, lies at origin + t direction, t in (0, furthest).
  bool occluded(const glm::vec3& origin, const glm::vec3& direction, float furthest) const;

  /// Origin for rays that leave the surface on the side of `geometric`: offset by a bound of the
  /// triangle's own rounding errors, so that they do not hit it again. Needs position, geometric
  /// and point.
  glm::vec3 offset_origin(const Hit& hit) const;

  /// Translation of a point on surfaces, those nearer than half of `distance`, to `distance` from
  /// them: to their fronts, or to the side to which `normal` points. 0 for other points.
  glm::dvec3 way_off_surfaces(const glm::dvec3& point, const glm::dvec3& normal,
                              double distance) const;

  struct Impl;  ///< Embree's objects; public for the filter functions in the .cpp

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace clpv::pathtracer
