// SPDX-License-Identifier: MIT
// A frame: every stage in its order, for one scene and one set of options (docs/method.md, 'The frame').
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/session.hpp"
#include "options/render_options.hpp"
#include "pipeline/block.hpp"
#include "pipeline/cascade.hpp"
#include "pipeline/gather.hpp"
#include "pipeline/inject.hpp"
#include "pipeline/propagate.hpp"
#include "pipeline/rasterize.hpp"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/see.hpp"
#include "pipeline/shade.hpp"
#include "pipeline/sweep.hpp"
#include "pipeline/tuning.hpp"
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
  const Buffer* hidden;  ///< SceneSight::hidden(); null where all cells light a surface
  float scale;           ///< they hold so many times the light
};

/// Holds all device memory a frame needs; render() may be called again and again, for one camera or many.
class Frame {
 public:
  /// Throws Error(run_time) where the device's memory does not suffice, naming a grid that would fit.
  /// `tuning`: launch shapes of propagation, for options.layout; by default the usual ones.
  Frame(Session& session, const Scene& scene, const RenderOptions& options, const Tuning& tuning = {});
  Frame(const Frame&) = delete;  // its stages refer to its other parts
  Frame& operator=(const Frame&) = delete;

  /// To be called when the scene given shows another instant (MovingScene): the next frame is of that.
  void scene_moved();

  /// Enqueues all stages, marked on the session's timeline; shaded views are there once the queue is finished.
  /// `observer` sees each cascade's volumes (and waits for the device, so leave it out of a timed frame).
  void render(const Camera& camera, const CascadeObserver& observer = {});

  /// Empty before the first render.
  GatheredLight light() const;

  /// One view of the last render, as RGBA float, row 0 on top.
  std::vector<float> read(Show view);

  const RenderOptions& options() const { return options_; }
  const Basis& basis() const { return *basis_; }  ///< of injected light
  /// Of light on its way to surfaces: that of injected light, or what a sweep leaves.
  const Basis& gathered() const { return swept_ ? *swept_ : *basis_; }
  const Transport& transport() const { return transport_; }

 private:
  struct LitLight {  ///< a light and what is rasterised for it
    ClpvLight light;
    int index;                  ///< in Scene::lights
    std::vector<Surface> rsms;  ///< one, or six
    ShadowedLight shadow;
  };
  void prepare_lights(const Camera& camera);
  void rasterize_camera(const Camera& camera);
  void rasterize_shadows();
  void light_cascade(int cascade, const CascadeObserver& observer);
  void rasterize_rsms(int cascade);
  void inject(int cascade);
  void inject_geometry(int cascade);
  bool stands(std::vector<std::optional<ClpvGrid>>& known, int cascade) const;
  bool block(int cascade);
  void see(int cascade);
  void propagate(int cascade);
  Volume& geometry_of(int cascade) { return *geometry_[blocker_ ? static_cast<std::size_t>(cascade) : 0]; }

  Session& session_;
  const Scene& scene_;
  std::unique_ptr<Basis> basis_, swept_;  ///< swept_: null without a sweep
  RenderOptions options_;
  Transport transport_;
  SceneBuffers buffers_;
  Rasterizer rasterizer_;
  Injector injector_;
  std::optional<SceneBlocker> blocker_;   ///< none: what is seen blocks
  std::optional<Propagator> propagator_;  ///< one of the two
  std::optional<Sweeper> sweeper_;
  std::optional<SceneSight> sight_;  ///< none: all cells light a surface
  Gatherer gatherer_;
  Shader shader_;
  std::optional<Surface> camera_surface_;
  std::vector<LitLight> lights_;
  std::string lit_by_;  ///< Camera::light that lights_ were prepared for
  std::vector<ClpvGrid> grids_;
  float light_scale_ = 1;  ///< what volumes hold in place of 1 W/sr
  Volume injected_;
  std::vector<std::unique_ptr<Volume>>
      geometry_;  ///< none without occlusion; what the scene blocks, a cascade; else one
  std::vector<std::optional<ClpvGrid>> blocked_,
      seen_;  ///< the grids that what the scene blocks, and hides, is known of
  std::vector<std::unique_ptr<Volume>> accumulated_;
  Buffer irradiance_;  ///< float4 a pixel, as is image_
  Buffer image_;
  Show shown_ = Show::full;
};

}  // namespace clpv
