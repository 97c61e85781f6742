// SPDX-License-Identifier: MIT
// Emissive surfaces of a frame: the points they light from, kept while these surfaces, and how fine they are to be, stay as
// they are.
#pragma once

#include <vector>

#include "pipeline/emit.hpp"
#include "pipeline/made_of.hpp"
#include "scene/emission.hpp"

namespace clpv {

class FrameEmission {
 public:
  /// All must stay as long as this does. `scene` has emissive triangles; `buffers` are of it, at the instant it shows.
  FrameEmission(Session& session, const Scene& scene, const SceneBuffers& buffers);

  /// most_emitted() of the scene as it is now. `triangles`: what the scene's are made of now.
  double most(double cell, const MadeOf& triangles);

  /// Decides where points are, for cascades at `grids`; they have `scale` times their flux.
  void prepare(const std::vector<ClpvGrid>& grids, const MadeOf& triangles, float scale);

  /// Brings the points to date.
  void emit();

  /// Of the points that emit() leaves.
  const MadeOf& made_of() const { return made_of_; }
  const Surface& points() const { return emitter_.points(); }

  /// Next time they are made anew.
  void forget() { emitted_.forget(); }

 private:
  Session& session_;
  const Scene& scene_;
  std::vector<std::uint32_t> triangles_;  ///< that emit
  bool moving_ = false;                   ///< some of them do
  Emitter emitter_;
  EmissionPlan plan_;
  Kept measured_, planned_, emitted_;
  double most_ = 0;
  int coarsened_ = 0;  ///< as said in the log
  float scale_ = 1;
  MadeOf made_of_;
};

}  // namespace clpv
