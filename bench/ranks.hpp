// SPDX-License-Identifier: MIT
// Frames that ranks of a team render together, at rank 0's word: what suite `scaling` times along the axis `ranks`.
#pragma once

#include <memory>

#include "device/session.hpp"
#include "parallel/team.hpp"
#include "pipeline/frame.hpp"
#include "scene/scene.hpp"

namespace clpv::bench {

class RankWork {
 public:
  /// Each rank's own frame, made when it is first needed.
  RankWork(Team& team, Session& session, std::shared_ptr<const Scene> scene, Camera camera,
           const RenderOptions& options);

  int most_ranks() const { return team_.size(); }

  /// At rank 0: the first `ranks` ranks render so many frames, each its part; returns when all have.
  void render(int ranks, int frames);
  void end();  ///< at rank 0: there will be no more

  /// At other ranks: does as rank 0 says, until there is no more.
  void serve();

 private:
  void share(int ranks, int frames);

  Team& team_;
  Session& session_;
  std::shared_ptr<const Scene> scene_;
  Camera camera_;
  RenderOptions options_;
  std::unique_ptr<Frame> frame_;
};

}  // namespace clpv::bench
