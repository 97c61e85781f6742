// SPDX-License-Identifier: MIT
// Stage `emit`: converts emissive triangles to virtual point lights (kernels/inject/emit.cl;
// docs/method.md, 'Emissive surfaces').
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "device/kernel.hpp"
#include "device/session.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/raster/surface.hpp"
#include "scene/emission.hpp"

namespace clpv {

/// Places the points of a plan on a scene's triangles. Deterministic: a point depends only on its
/// index in the plan.
class Emitter {
 public:
  /// `scene` must not change.
  Emitter(Session& session, const SceneBuffers& scene);

  /// Recomputes the points, with their flux multiplied by `scale`.
  void emit(const EmissionPlan& plan, float scale);

  /// Positions, normals and fluxes [W] of the points, for injection.
  const Surface& points() const { return points_; }

 private:
  Session& session_;
  const SceneBuffers& scene_;
  Kernel emit_;
  Buffer parts_;
  Surface points_;
};

}  // namespace clpv
