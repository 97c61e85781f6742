// SPDX-License-Identifier: MIT
#include "clpv/scene.hpp"

#include "door/scene_contents.hpp"
#include "scene/load.hpp"

namespace clpv {

SceneFile::SceneFile(const std::filesystem::path& path, const std::filesystem::path& model)
    : contents_(std::make_shared<const Contents>(Contents{load_scene(path, {model})})) {}

std::vector<std::string> SceneFile::cameras() const {
  std::vector<std::string> names;
  for (const Camera& camera : contents_->scene.cameras) names.push_back(camera.name);
  return names;
}

std::vector<std::string> SceneFile::notes() const {
  return {contents_->scene.notes.begin(), contents_->scene.notes.end()};
}

}  // namespace clpv
