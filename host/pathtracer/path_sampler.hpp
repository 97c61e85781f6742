// SPDX-License-Identifier: MIT
// The rays of one pixel: what it sees, its direct light, and single paths of its indirect light.
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

/// Borrows all it is made of. Cheap to make: one a thread, so that rays are counted without sharing.
class PathSampler {
 public:
  PathSampler(const RayScene& rays, const std::vector<Light>& lights, const Emitters& emitters,
              const SkySampler& sky, const PathTracerOptions& options)
      : rays_(rays), lights_(lights), emitters_(emitters), sky_(sky), options_(options) {}

  /// The surface at a pixel's centre, its depth as `distance`.
  std::optional<Hit> see(const ClpvView& view, std::uint32_t px, std::uint32_t py);

  /// Irradiance [W/m^2] straight from the lights.
  glm::dvec3 direct(const Hit& hit);

  /// One path's estimate of the irradiance [W/m^2] that reaches `start` from other surfaces, what these
  /// emit included, and from the sky. Paths 0, 1, 2... of a
  /// stream spread evenly over all directions; streams are independent of each other.
  glm::dvec3 indirect(const Hit& start, std::uint32_t path, std::uint64_t stream);

  std::uint64_t rays_shot() const { return shot_; }

 private:
  glm::dvec3 looked_for(const Hit& at, const glm::dvec2& point);
  glm::dvec3 looked_up(const Hit& at, const glm::dvec2& point);
  glm::dvec3 missed(const Hit& at, const glm::dvec3& direction) const;
  glm::dvec3 met(const Hit& at, const glm::dvec3& direction, const Hit& next) const;
  bool shadowed(const ClpvLight& light, const glm::vec3& origin, const glm::dvec3& towards) const;

  const RayScene& rays_;
  const std::vector<Light>& lights_;
  const Emitters& emitters_;
  const SkySampler& sky_;
  const PathTracerOptions& options_;
  std::uint64_t shot_ = 0;
};

}  // namespace clpv::reference
