// SPDX-License-Identifier: MIT
// Loading of scene files and glTF models, static or animated.
#pragma once

#include <filesystem>
#include <functional>

#include "scene/added_meshes.hpp"
#include "scene/input.hpp"
#include "scene/motion.hpp"
#include "scene/scene.hpp"
#include "scene/scene_file.hpp"

namespace clpv {

/// Loads a scene file (.json: see docs/scenes.md) or a model (.gltf, .glb) at 0 s. A `model` that
/// is not empty replaces the file's. Input is untrusted: sizes are checked before allocation, and
/// nothing outside the model's folder is read. Throws Error(bad_input) that names file, place (JSON
/// pointer), value found and value allowed.
SceneData load_scene(const std::filesystem::path& path, const std::filesystem::path& model = {});

/// A scene that may be animated, loaded once and posed at any time. A default camera frames the
/// scene at 0 s.
class MovingScene {
 public:
  /// A scene without meshes.
  MovingScene();

  /// Loads the scene at 0 s. Throws as load_scene().
  explicit MovingScene(const std::filesystem::path& path, const std::filesystem::path& model = {});

  /// The scene at the time of the last pose(); it depends on that time only. The reference is valid
  /// as long as this object.
  const SceneData& scene() const { return scene_; }

  /// Returns true if anything is animated.
  bool moves() const { return !motion_.empty() || description_.moves(); }

  /// Poses the scene at a time. Throws Error(bad_input) if values leave their bounds.
  void pose(double seconds);

  /// Replace all cameras (at least one) or lights; they are then not animated, and lights not
  /// scaled. A camera whose only light is gone gets all. Call before pose().
  void set_cameras(std::vector<SceneCamera> cameras);
  void set_lights(std::vector<SceneLight> lights);

  /// Replaces the factor of the intensities of the file's lights. Throws Error(usage) if it has
  /// none.
  void set_light_scale(double scale);

  /// Replaces the medium or removes it. One without a box, `lower` equal to `upper`, fills the
  /// scene's bounding box, which follows added, removed and moved meshes.
  void set_medium(std::optional<ClpvMedium> medium);
  void set_sky(std::shared_ptr<const Sky> sky) { scene_.sky = std::move(sky); }
  bool medium_fills_scene() const { return medium_fills_scene_; }

  /// Changes meshes in memory, and updates what depends on them. `change` returns true if
  /// SceneData::moving is longer. Returns true if frames allocate their memory again: it is, or the
  /// medium's box changed. Call before pose().
  using MeshChange = std::function<bool(AddedMeshes& meshes, SceneData& scene)>;
  bool change_meshes(const MeshChange& change);

  SceneData take() && { return std::move(scene_); }

 private:
  void load_scene_file(const std::filesystem::path& path, const std::filesystem::path& model,
                       Notes& notes);
  void set_views(SceneViews views);
  void add_defaults(bool has_lights);
  /// Fits a medium without a box of its own to the scene. Returns true if its box changed.
  bool fit_medium();

  Motion motion_;
  AddedMeshes added_;
  SceneDescription description_;  ///< empty without a scene file
  SceneData scene_;
  bool medium_fills_scene_ = false;
};

inline constexpr double kSunIlluminance = 10;  ///< sun that a model without lights gets [lx]

/// Returns true if the scene has no scene file, and thus no settings of cascades: a model, or
/// meshes in memory.
bool is_bare_model(const SceneData& scene);

// Writes a scene as a binary glTF file.

/// Writes meshes, materials, textures, cameras and lights to a .glb. Logs a warning for a sky, a
/// medium and cameras with an only light, which glTF has not. Throws Error: usage (another
/// extension), run_time (the file cannot be written, or would be larger than 4 GiB).
void write_glb(const std::filesystem::path& path, const SceneData& scene);

}  // namespace clpv
