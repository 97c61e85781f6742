// SPDX-License-Identifier: MIT
// Stage `emit`: what a scene's emissive triangles send out, as virtual point lights (kernels/emit.cl; docs/method.md, 'Emissive
// surfaces').
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/surface.hpp"
#include "scene/emission.hpp"

namespace clpv {

/// Puts the points of a plan onto a scene's triangles. Deterministic: a point depends on its place in the plan alone.
class Emitter {
 public:
  /// `scene` must stay as it is.
  Emitter(Session& session, const SceneBuffers& scene);

  /// Makes the points anew, their fluxes `scale` times what they are.
  void emit(const EmissionPlan& plan, float scale);

  /// Positions, normals and fluxes, for injection.
  const Surface& points() const { return points_; }

 private:
  Session& session_;
  const SceneBuffers& scene_;
  Kernel emit_;
  Buffer parts_;
  Surface points_;
};

}  // namespace clpv
