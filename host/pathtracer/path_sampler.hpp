// SPDX-License-Identifier: MIT
// Sampling of one pixel: primary hit, direct irradiance, and single paths of indirect irradiance.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "kernels/shared/view.h"
#include "pathtracer/emitters.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pathtracer/ray_scene.hpp"

namespace clpv::reference {

/// Borrows its arguments. Each thread has its own, for its count of rays.
class PathSampler {
 public:
  PathSampler(const RayScene& rays, const std::vector<SceneLight>& lights, const Emitters& emitters,
              const SkySampler& sky, const PathTracerOptions& options)
      : rays_(rays), lights_(lights), emitters_(emitters), sky_(sky), options_(options) {}

  /// The surface at a pixel's centre; `distance` is its depth. Empty without a surface.
  std::optional<Hit> primary_hit(const ClpvView& view, std::uint32_t px, std::uint32_t py);

  /// Irradiance from the scene's lights [W/m^2].
  glm::dvec3 direct(const Hit& hit);

  /// One path's estimate of the irradiance at `start` from other surfaces, emission included, and from the sky [W/m^2].
  /// Paths 0, 1, 2... of a stream are a low-discrepancy sequence; streams are independent of each other.
  glm::dvec3 indirect(const Hit& start, std::uint32_t path, std::uint64_t stream);

  std::uint64_t ray_count() const { return ray_count_; }

 private:
  glm::dvec3 sample_emitter(const Hit& at, const glm::dvec2& random);
  glm::dvec3 sample_sky(const Hit& at, const glm::dvec2& random);
  glm::dvec3 sky_along(const Hit& at, const glm::dvec3& direction) const;
  glm::dvec3 emission_of(const Hit& at, const glm::dvec3& direction, const Hit& next) const;
  bool shadowed(const ClpvLight& light, const glm::vec3& origin, const glm::dvec3& towards) const;

  const RayScene& rays_;
  const std::vector<SceneLight>& lights_;
  const Emitters& emitters_;
  const SkySampler& sky_;
  const PathTracerOptions& options_;
  std::uint64_t ray_count_ = 0;
};

}  // namespace clpv::reference
