// SPDX-License-Identifier: MIT
// Scene files and glTF models into a Scene.
#pragma once

#include <filesystem>

#include "scene/motion.hpp"
#include "scene/notes.hpp"
#include "scene/scene.hpp"
#include "scene/scene_file.hpp"

namespace clpv {

/// Loads a scene file (.json: see docs/scenes.md), or a bare .gltf / .glb. `model` replaces the file's; empty: as it says.
/// Untrusted input: everything is bounded before it is allocated, nothing outside the model's folder is read.
/// Throws Error(bad_input) that names file, place (JSON pointer), value found and value allowed.
/// What it shows is the scene at 0 s.
Scene load_scene(const std::filesystem::path& path, const std::filesystem::path& model = {});

/// A scene that may move: read once, and shown at any instant. What is added where the files say nothing (a camera that
/// frames the model) fits the scene at 0 s, and stays.
class MovingScene {
 public:
  /// At 0 s. Reads and throws as load_scene does.
  explicit MovingScene(const std::filesystem::path& path, const std::filesystem::path& model = {});

  /// At the instant posed last: the same scene for the same instant, whatever came before. It stays where it is as long as
  /// the MovingScene does.
  const Scene& scene() const { return scene_; }

  bool moves() const { return !motion_.empty() || description_.moves(); }

  /// Throws Error(bad_input) for what moves out of what is allowed.
  void pose(double seconds);

  Scene take() && { return std::move(scene_); }

 private:
  void load_described(const std::filesystem::path& path, const std::filesystem::path& model, Notes& notes);
  void show(DescribedViews views);

  Motion motion_;
  SceneDescription description_;  ///< without a scene file: it says nothing
  Scene scene_;
};

/// Whether the scene is a model without a scene file, which says nothing of cascades.
bool is_bare_model(const Scene& scene);

}  // namespace clpv
