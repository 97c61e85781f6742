// SPDX-License-Identifier: MIT
// Scene files: model, units, cameras, lights, sky and their keys. docs/scenes.md describes the
// format.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "scene/scene.hpp"
#include "scene/scene_keys.hpp"

namespace clpv {

struct SceneDescription {
  std::string file;             ///< path from the user, for messages
  std::filesystem::path model;  ///< resolved against the file's folder; empty if absent
  double metres_per_unit = 1;
  std::optional<float> exposure;  ///< [EV]
  std::optional<float> light_scale;
  std::optional<float> cascade_size;  ///< [m]
  std::optional<int> cascades;
  std::shared_ptr<const Sky> sky;    ///< null if absent
  std::filesystem::path sky_map;     ///< its file; empty if absent
  std::optional<ClpvMedium> medium;  ///< without a box: lower and upper are equal
  std::optional<std::vector<KeyedEntry>> cameras, lights;  ///< replace the model's, unless absent

  /// Returns true if a camera or light has keys.
  bool moves() const;
};

/// Cameras and lights of a scene file at a time, in metres; empty if absent in the file.
struct SceneViews {
  std::optional<std::vector<SceneCamera>> cameras;
  std::optional<std::vector<SceneLight>> lights;
};

/// Reads a scene file. Throws Error(bad_input), also for unknown keys.
SceneDescription read_scene_file(const std::filesystem::path& path);

/// Evaluates cameras and lights at a time. Throws Error(bad_input) that names the time.
SceneViews views_at(const SceneDescription& description, double seconds);

}  // namespace clpv
