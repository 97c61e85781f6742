// SPDX-License-Identifier: MIT
// Emissive surfaces of a frame: caches their virtual point lights until the surfaces or the
// required density change.
#pragma once

#include <vector>

#include "pipeline/frame/cached.hpp"
#include "pipeline/inject/emit.hpp"
#include "scene/emission.hpp"

namespace clpv {

class FrameEmission {
 public:
  /// All arguments must outlive this object. `scene` has emissive triangles; `buffers` hold it at
  /// its current time.
  FrameEmission(Session& session, const SceneData& scene, const SceneBuffers& buffers);

  /// Returns max_emitted_flux() of the scene at its current time [W].
  double max_flux(double cell);

  /// Plans the points for cascades at `grids`, with their flux multiplied by `scale`. A new `epoch`
  /// recomputes them.
  void prepare(const std::vector<ClpvGrid>& grids, float scale, unsigned epoch);

  /// Updates the points.
  void emit();

  /// Key of the points that emit() computes.
  CacheKey key() const { return key_; }
  const Surface& points() const { return emitter_.points(); }

 private:
  /// Version of the emissive triangles.
  unsigned instant() const { return moving_ ? buffers_.clusters->instant() : 0; }

  Session& session_;
  const SceneData& scene_;
  const SceneBuffers& buffers_;
  std::vector<std::uint32_t> triangles_;  ///< emissive triangles
  bool moving_ = false;                   ///< true if some of them move
  Emitter emitter_;
  EmissionPlan plan_;
  Cached measured_, planned_, emitted_;
  double max_flux_ = 0;
  int coarsened_ = 0;  ///< last value logged
  float scale_ = 1;
  CacheKey key_ = 0;
};

}  // namespace clpv
