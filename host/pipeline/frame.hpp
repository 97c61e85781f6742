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
#include "pipeline/frame_emission.hpp"
#include "pipeline/frame_lights.hpp"
#include "pipeline/gather.hpp"
#include "pipeline/inject.hpp"
#include "pipeline/made_of.hpp"
#include "pipeline/propagate.hpp"
#include "pipeline/rasterize.hpp"
#include "pipeline/reflect.hpp"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/see.hpp"
#include "pipeline/shade.hpp"
#include "pipeline/sweep.hpp"
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
  Frame(Session& session, const Scene& scene, const RenderOptions& options);
  Frame(const Frame&) = delete;  // its stages refer to its other parts
  Frame& operator=(const Frame&) = delete;

  /// To be called when the scene given may show another instant (MovingScene): the next frame is of that.
  void scene_moved();

  /// Enqueues the stages whose products are not there yet, marked on the session's timeline, which forgets the frame before;
  /// shaded views are there once the queue is finished. A frame is the same to the bit, whatever was rendered before it.
  /// `observer` sees each cascade's volumes (and waits for the device, so leave it out of a timed frame).
  void render(const Camera& camera, const CascadeObserver& observer = {});

  /// What benchmarks time: the next frame makes its light anew, from shadow maps on, as if all lights had changed; or all of
  /// it, with what the scene's triangles block and hide.
  void forget_light();
  void forget();

  /// Empty before the first render.
  GatheredLight light() const;

  /// What the camera of the last render sees. None before it.
  const Surface& seen() const { return *camera_surface_; }

  /// Irradiance of the last render's light on surfaces that its camera need not see, as Gatherer gives it.
  std::vector<float> irradiance_on(const SurfaceImage& surfaces);

  /// One view of the last render, as RGBA float, row 0 on top.
  std::vector<float> read(Show view);

  const RenderOptions& options() const { return options_; }
  const Basis& basis() const { return *basis_; }  ///< of injected light
  /// Of light on its way to surfaces: that of injected light, or what a sweep leaves.
  const Basis& gathered() const { return swept_ ? *swept_ : *basis_; }

 private:
  /// A volume and what it holds: one a cascade, or one for all in turn.
  struct KeptVolume {
    std::unique_ptr<Volume> volume;
    Kept kept;
  };
  std::vector<KeptVolume> volumes(int count, const VolumeShape& shape, const char* what) const;
  static KeptVolume& of_cascade(std::vector<KeptVolume>& volumes, int cascade);

  /// What a cascade's products are made of.
  MadeOf injected_made_of(int cascade) const;
  MadeOf geometry_made_of(int cascade) const;
  MadeOf reflected_made_of(int cascade) const;
  MadeOf accumulated_made_of(int cascade) const;

  /// Each brings a cascade's product to date, and what that is made of before it where it is not.
  void inject(int cascade);
  void block(int cascade);
  void let_through(int cascade);
  void reflect(int cascade);
  void propagate(int cascade);
  void see(int cascade);

  void prepare_light(const Camera& camera);
  void rasterize_camera(const Camera& camera);
  void inject_geometry(int cascade, Volume& geometry);
  void light_cascade(int cascade, const CascadeObserver& observer);
  void gather(const Surface& surface, Buffer& irradiance);
  const ClpvGrid& grid(int cascade) const { return grids_[static_cast<std::size_t>(cascade)]; }

  Session& session_;
  const Scene& scene_;
  std::unique_ptr<Basis> basis_, swept_;  ///< swept_: null without a sweep
  RenderOptions options_;
  Transport transport_;
  SceneBuffers buffers_;
  Rasterizer rasterizer_;
  Injector injector_;
  std::optional<SceneBlocker> blocker_;      ///< none: what is seen blocks
  std::optional<SceneReflector> reflector_;  ///< none: one bounce
  std::optional<Propagator> propagator_;     ///< one of the two
  std::optional<Sweeper> sweeper_;
  std::optional<SceneSight> sight_;  ///< none: all cells light a surface
  Gatherer gatherer_;
  Shader shader_;
  FrameLights lights_;
  std::optional<FrameEmission> emission_;  ///< none: no surface glows
  MadeOf triangles_;                       ///< the scene's, as they are now
  std::optional<Surface> camera_surface_;
  std::vector<ClpvGrid> grids_;
  std::vector<KeptVolume> injected_, accumulated_;
  std::vector<KeptVolume> geometry_;  ///< none without occlusion
  std::vector<Kept> ways_, seen_;     ///< of the sweeper and the sight, a cascade
  std::vector<Kept> reflected_;       ///< of the reflector and the sweeper
  std::vector<Kept> packed_;          ///< accumulated light as the gatherer holds it
  Buffer irradiance_;                 ///< float4 a pixel, as is image_
  Buffer image_;
  Show shown_ = Show::full;
  float brightest_sky_;  ///< [W/m^2/sr]
};

}  // namespace clpv
