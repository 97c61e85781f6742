// SPDX-License-Identifier: MIT
// A scene that rays can be shot through: Embree in its robust mode, with alpha masks and the colours of what
// is hit.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "kernels/shared/view.h"
#include "reference/materials.hpp"
#include "scene/scene.hpp"

namespace clpv::reference {

/// Where a ray met a surface.
struct Hit {
  float distance = 0;      ///< in lengths of the ray's direction
  glm::vec3 position{0};   ///< [m], from the vertices: closer to the surface than origin + distance
  glm::vec3 geometric{0};  ///< unit normal of the triangle, towards where the ray came from
  glm::vec3 normal{0};     ///< unit, interpolated between the vertices, on the side of `geometric`
  SurfacePoint point;      ///< the same position on its triangle
};

/// The footprint of the pixel (px, py) that sees `hit`, its `distance` the depth.
Footprint footprint(const ClpvView& view, unsigned px, unsigned py, const Hit& hit);

/// Which surfaces a ray can hit.
enum class Faces {
  as_seen,  ///< what a camera draws: single-sided triangles from their front only
  both,     ///< what a light draws: every triangle from either side
};

/// Borrows the scene: it must outlive this. Safe to shoot rays through from several threads.
class RayScene {
 public:
  /// Throws Error(bad_input) where there is no triangle;
  /// Error(run_time) where Embree fails (out of memory).
  explicit RayScene(const Scene& scene);
  ~RayScene();
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;

  const Materials& materials() const;

  /// The nearest surface at origin + t direction, t in (nearest, furthest). Holes of masked materials let it
  /// pass.
  std::optional<Hit> intersect(const glm::vec3& origin, const glm::vec3& direction, float nearest,
                               float furthest, Faces faces) const;

  /// Whether anything stands on origin + t direction, t in (0, furthest), from either side.
  bool occluded(const glm::vec3& origin, const glm::vec3& direction, float furthest) const;

  /// A start for rays that leave the hit's surface on the side of `geometric`: far enough off not to meet it
  /// again.
  glm::vec3 leave(const Hit& hit) const;

  struct Impl;  ///< Embree's side, seen by its filters in the .cpp alone

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace clpv::reference
