// SPDX-License-Identifier: MIT
// Cascades of a frame: their volumes, and the stages that compute them. Each result is cached with
// a key over its inputs and recomputed only when the key changes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "device/session.hpp"
#include "pipeline/frame/cached.hpp"
#include "pipeline/frame/frame_lights.hpp"
#include "pipeline/frame/frame_setup.hpp"
#include "pipeline/gather/gather.hpp"
#include "pipeline/inject/inject.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/steps/propagate.hpp"
#include "pipeline/sweep/sweep.hpp"
#include "pipeline/voxels/voxel_field.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Volumes of one cascade after its propagation. Accumulated light uses the basis
/// Frame::gathered().
struct CascadeVolumes {
  int cascade;
  const ClpvGrid& grid;
  const Volume& injected;
  const Volume* geometry;  ///< null without occlusion
  const Volume& accumulated;
  float light_scale;  ///< factor by which the volumes scale the light
};
using CascadeObserver = std::function<void(const CascadeVolumes&)>;

class FrameCascades {
 public:
  /// All arguments must outlive this object.
  FrameCascades(Session& session, const SceneData& scene, const SceneBuffers& buffers,
                const FrameSetup& setup, FrameLights& lights);

  /// Sets the cascade grids and the camera's G-buffer, which FrameSetup::blocked_by_view() needs;
  /// else it may be null. Call for each frame, after preparing its lights.
  void prepare(const std::vector<ClpvGrid>& grids, const Surface* camera);

  /// Updates the light of a cascade. Call for the coarsest cascade first.
  void update(int cascade, const CascadeObserver& observer);

  /// Light of the cascades at the grids of the last prepare().
  GatheredLight light() const;

 private:
  /// A volume and the key of its contents. There is one per cascade, or one that all cascades share
  /// in turn.
  struct CachedVolume {
    std::unique_ptr<Volume> volume;
    Cached cached;
  };
  /// Keys of a cascade's results.
  struct Keys {
    CacheKey triangles = 0, injected = 0, geometry = 0, surfaces = 0, accumulated = 0;
  };
  /// `array`: in one buffer.
  std::vector<CachedVolume> volumes(int count, const VolumeShape& shape, const char* what,
                                    bool array = false) const;
  static CachedVolume& of_cascade(std::vector<CachedVolume>& volumes, int cascade);
  Keys keys_of(int cascade) const;
  const Volume* geometry(int cascade);

  /// Each function updates one result of a cascade, and first the inputs it depends on.
  void inject(int cascade);
  void inject_light(int first, int last);
  void update_blockers(int cascade);
  void update_links(int cascade);
  Buffer occluded(int cascade);
  void update_surfaces(int cascade);
  void propagate(int cascade);
  void update_visibility(int cascade);
  void inject_geometry(int cascade, Volume& geometry);

  Session& session_;
  const SceneData& scene_;
  const SceneBuffers& buffers_;
  const FrameSetup& setup_;
  const RenderOptions& options_;
  FrameLights& lights_;
  Injector injector_;
  std::optional<VoxelField>
      blockers_;                     ///< none: surfaces in images block, or sample points see links
  std::optional<VoxelField> white_;  ///< none without a sweep
  std::optional<VoxelField> reflectors_;  ///< none with one bounce
  std::optional<VoxelField> visibility_;  ///< none: all cells light a surface
  std::optional<Propagator> propagator_;  ///< either propagator_ or sweeper_ is set
  std::optional<Sweeper> sweeper_;
  std::vector<CachedVolume> injected_, accumulated_;
  std::vector<CachedVolume> geometry_;  ///< none without blockers that need it
  std::unique_ptr<Volume> white_faces_,
      reflected_;  ///< faces of white_ and reflectors_, as surfaces_ uses them
  /// Contents of the sweeper and of visibility_, per cascade.
  std::vector<Cached> links_, surfaces_, visible_cells_;
  std::vector<ClpvGrid> grids_;
  std::vector<Keys> keys_;
  const Surface* camera_ = nullptr;
};

}  // namespace clpv
