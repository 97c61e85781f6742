// SPDX-License-Identifier: MIT
// Data of a Scene, shared by its copies and their renderers.
#pragma once

#include <mutex>
#include <optional>
#include <shared_mutex>
#include <vector>

#include "clpv/scene.hpp"
#include "scene/load.hpp"
#include "scene/view_values.hpp"

namespace clpv {

struct Scene::Contents {
  mutable std::shared_mutex mutex;  ///< shared by frames in progress; exclusive for changes
  MovingScene moving;               ///< at 0 s
  /// Arguments of the last set_cameras() and set_lights().
  std::optional<std::vector<SceneCamera>> cameras;
  std::optional<std::vector<SceneLight>> lights;
  /// The same as they were given, in double.
  struct {
    std::optional<std::vector<Camera>> cameras;
    std::optional<std::vector<Light>> lights;
    std::optional<std::optional<Medium>> medium;
  } given;
  unsigned rebuilds = 0;    ///< changes after which frames allocate their memory again
  unsigned geometries = 0;  ///< changes of meshes
  unsigned changes = 0;     ///< counts changes of any kind

  void change_meshes(const MovingScene::MeshChange& change) {
    const std::lock_guard lock(mutex);
    const bool rebuilds_frames = moving.change_meshes(change);
    ++geometries, ++changes, rebuilds += rebuilds_frames ? 1 : 0;
  }

  void change_sky(std::shared_ptr<const Sky> sky) {
    const std::lock_guard lock(mutex);
    moving.set_sky(std::move(sky));
    ++rebuilds, ++changes;
  }

  Contents() = default;
  Contents(const std::filesystem::path& path, const std::filesystem::path& model)
      : moving(path, model) {}
};

/// A scene that a frame or the path tracer reads, at any time: the shared one, or a copy if it is
/// animated. Hold Contents::mutex while it is used.
class PosedScene {
 public:
  explicit PosedScene(const Scene& file);

  const SceneData& scene() const {
    return posed_ ? posed_->scene() : file_.contents().moving.scene();
  }

  /// Throws Error(usage) for a camera or a time that camera() or pose() rejects; changes nothing.
  void check(const CameraChoice& choice, double seconds) const;

  /// Poses the scene and applies changes of the shared one. Returns true if the scene may have
  /// moved. Throws Error(usage) for a time out of range.
  bool pose(double seconds);

  /// The camera chosen. One by value has its numbers as name. Throws Error(usage).
  SceneCamera camera(const CameraChoice& choice) const;

 private:
  Scene file_;
  std::optional<MovingScene> posed_;
  unsigned geometries_;  ///< at the last pose
};

}  // namespace clpv
