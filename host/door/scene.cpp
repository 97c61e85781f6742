// SPDX-License-Identifier: MIT
#include "clpv/scene.hpp"

#include "door/scene_contents.hpp"

namespace clpv {

SceneFile::SceneFile(const std::filesystem::path& path, const std::filesystem::path& model)
    : contents_(std::make_shared<const Contents>(Contents{MovingScene(path, {model})})) {}

std::vector<std::string> SceneFile::cameras() const {
  std::vector<std::string> names;
  for (const Camera& camera : contents_->moving.scene().cameras) names.push_back(camera.name);
  return names;
}

bool SceneFile::moves() const {
  return contents_->moving.moves();
}

std::vector<std::string> SceneFile::notes() const {
  return contents_->moving.scene().notes;
}

}  // namespace clpv
