// SPDX-License-Identifier: MIT
// The cascades of a frame: their volumes, and the stages that fill them. Each result is cached with a key over its inputs and
// recomputed only when the key changes.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/session.hpp"
#include "options/render_options.hpp"
#include "pipeline/blockers.hpp"
#include "pipeline/cached.hpp"
#include "pipeline/frame_lights.hpp"
#include "pipeline/inject.hpp"
#include "pipeline/propagate.hpp"
#include "pipeline/reflectors.hpp"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/sweep.hpp"
#include "pipeline/visibility.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// The volumes of one cascade, just after its propagation. What is accumulated is of Frame::gathered().
struct CascadeVolumes {
  int cascade;
  const ClpvGrid& grid;
  const Volume& injected;
  const Volume* geometry;  ///< null without occlusion
  const Volume& accumulated;
  float light_scale;  ///< the volumes hold so many times the light
};
using CascadeObserver = std::function<void(const CascadeVolumes&)>;

/// What a render left in its volumes to be gathered, finest cascade first.
struct GatheredLight {
  std::vector<ClpvGrid> grids;
  std::vector<const Volume*> accumulated;
  const Buffer* occluded;  ///< CellVisibility::occluded(); null where all cells light a surface
  float scale;             ///< they hold so many times the light
};

class FrameCascades {
 public:
  /// All must stay as long as this does. `swept`: the basis that a sweep leaves; null without one.
  FrameCascades(Session& session, const Scene& scene, const SceneBuffers& buffers,
                const RenderOptions& options, const Basis& basis, const Basis* swept,
                const Transport& transport, FrameLights& lights);

  /// To be called for each frame, once its lights are prepared: where cascades stand, and what the camera sees.
  void prepare(const std::vector<ClpvGrid>& grids, const Surface& camera);

  /// Brings a cascade's light to date; the coarsest comes first.
  void update(int cascade, const CascadeObserver& observer);

  /// Of a cascade's accumulated light.
  CacheKey key(int cascade) const { return keys_[cascade].accumulated; }
  GatheredLight light() const;

 private:
  /// A volume and what it holds: one a cascade, or one for all in turn.
  struct CachedVolume {
    std::unique_ptr<Volume> volume;
    Cached cached;
  };
  /// Keys of a cascade's results.
  struct Keys {
    CacheKey triangles = 0, injected = 0, geometry = 0, reflected = 0, accumulated = 0;
  };
  std::vector<CachedVolume> volumes(int count, const VolumeShape& shape, const char* what) const;
  static CachedVolume& of_cascade(std::vector<CachedVolume>& volumes, int cascade);
  Keys keys_of(int cascade) const;

  /// Each brings a cascade's result to date, and what it is computed from before it where it is not.
  void inject(int cascade);
  void block(int cascade);
  void let_through(int cascade);
  void reflect(int cascade);
  void propagate(int cascade);
  void see(int cascade);
  void inject_geometry(int cascade, Volume& geometry);
  const Volume* geometry(int cascade);

  Session& session_;
  const Scene& scene_;
  const SceneBuffers& buffers_;
  const RenderOptions& options_;
  FrameLights& lights_;
  Injector injector_;
  std::optional<BlockerVoxelizer> blocker_;      ///< none: what is seen blocks
  std::optional<ReflectorVoxelizer> reflector_;  ///< none: one bounce
  std::optional<Propagator> propagator_;         ///< one of the two
  std::optional<Sweeper> sweeper_;
  std::optional<CellVisibility> sight_;  ///< none: all cells light a surface
  std::vector<CachedVolume> injected_, accumulated_;
  std::vector<CachedVolume> geometry_;  ///< none without occlusion
  std::vector<Cached> links_, seen_,
      reflected_;  ///< of the sweeper, the sight, the reflector and the sweeper
  std::vector<ClpvGrid> grids_;
  std::vector<Keys> keys_;
  const Surface* camera_ = nullptr;
};

}  // namespace clpv
