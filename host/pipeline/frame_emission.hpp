// SPDX-License-Identifier: MIT
// Emissive surfaces of a frame: the points they light from, cached while these surfaces, and how fine they are to be, stay as
// they are.
#pragma once

#include <vector>

#include "pipeline/cached.hpp"
#include "pipeline/emit.hpp"
#include "scene/emission.hpp"

namespace clpv {

class FrameEmission {
 public:
  /// All must stay as long as this does. `scene` has emissive triangles; `buffers` are of it, at the instant it shows.
  FrameEmission(Session& session, const Scene& scene, const SceneBuffers& buffers);

  /// max_emitted_flux() of the scene as it is now.
  double most(double cell);

  /// Decides where points are, for cascades at `grids`; they have `scale` times their flux. Another `epoch` computes them again.
  void prepare(const std::vector<ClpvGrid>& grids, float scale, unsigned epoch);

  /// Brings the points to date.
  void emit();

  /// Of the points that emit() leaves.
  CacheKey key() const { return key_; }
  const Surface& points() const { return emitter_.points(); }

 private:
  /// The version of the emissive triangles.
  unsigned instant() const { return moving_ ? buffers_.clusters->instant() : 0; }

  Session& session_;
  const Scene& scene_;
  const SceneBuffers& buffers_;
  std::vector<std::uint32_t> triangles_;  ///< that emit
  bool moving_ = false;                   ///< some of them do
  Emitter emitter_;
  EmissionPlan plan_;
  Cached measured_, planned_, emitted_;
  double most_ = 0;
  int coarsened_ = 0;  ///< as said in the log
  float scale_ = 1;
  CacheKey key_ = 0;
};

}  // namespace clpv
