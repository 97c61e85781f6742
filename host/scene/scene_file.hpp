// SPDX-License-Identifier: MIT
// Our scene file: which model, in what units, seen and lit how, and when. docs/scenes.md describes the format.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "scene/scene.hpp"
#include "scene/scene_keys.hpp"

namespace clpv {

struct SceneDescription {
  std::string file;             ///< as the user named it, for messages
  std::filesystem::path model;  ///< resolved against the file's folder; empty: not given
  double metres_per_unit = 1;
  float exposure = 0;
  std::optional<float> cascade_size;  ///< [m]
  std::optional<int> cascades;
  std::shared_ptr<const Sky> sky;                          ///< null: not given
  std::optional<std::vector<KeyedEntry>> cameras, lights;  ///< given: they replace the model's

  bool moves() const;
};

/// The cameras and lights of a scene file at an instant, in metres; none where it does not give them.
struct DescribedViews {
  std::optional<std::vector<Camera>> cameras;
  std::optional<std::vector<Light>> lights;
};

/// Throws Error(bad_input), for unknown keys too.
SceneDescription read_scene_file(const std::filesystem::path& path);

/// Throws Error(bad_input) that names the instant where something moves.
DescribedViews views_at(const SceneDescription& description, double seconds);

}  // namespace clpv
