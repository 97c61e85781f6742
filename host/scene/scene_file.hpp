// SPDX-License-Identifier: MIT
// Our scene file: which model, in what units, seen and lit how. docs/scenes.md describes the format.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "scene/scene.hpp"

namespace clpv {

struct SceneFile {
  std::filesystem::path model;  ///< resolved against the file's folder; empty: not given
  double metres_per_unit = 1;
  float exposure = 0;
  std::optional<float> cascade_size;  ///< [m]
  std::optional<int> cascades;
  std::optional<std::vector<Camera>> cameras;  ///< in metres; given: replace the model's
  std::optional<std::vector<Light>> lights;    ///< in metres; given: replace the model's
};

/// Throws Error(bad_input), for unknown keys too.
SceneFile read_scene_file(const std::filesystem::path& path);

}  // namespace clpv
