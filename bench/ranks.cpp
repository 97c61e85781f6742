// SPDX-License-Identifier: MIT
#include "bench/ranks.hpp"

#include <nlohmann/json.hpp>
#include <utility>

namespace clpv::bench {

RankWork::RankWork(Team& team, Session& session, std::shared_ptr<const Scene> scene, Camera camera,
                   const RenderOptions& options)
    : team_(team),
      session_(session),
      scene_(std::move(scene)),
      camera_(std::move(camera)),
      options_(options) {}

void RankWork::render(int ranks, int frames) {
  team_.from_root([&] { return nlohmann::json{ranks, frames}.dump(); });
  share(ranks, frames);
}

void RankWork::end() {
  team_.from_root([] { return "[]"; });
}

void RankWork::serve() {
  for (;;) {
    const auto said = nlohmann::json::parse(team_.from_root([] { return ""; }));
    if (said.empty()) return;
    share(said[0], said[1]);
  }
}

void RankWork::share(int ranks, int frames) {
  const bool mine = team_.rank() < ranks;
  if (mine && !frame_) frame_ = std::make_unique<Frame>(session_, *scene_, options_);
  team_.barrier();
  for (int i = team_.rank(); mine && i < frames; i += ranks) {
    frame_->forget_light();
    frame_->render(camera_);
    session_.queue().finish();
  }
  team_.barrier();
}

}  // namespace clpv::bench
