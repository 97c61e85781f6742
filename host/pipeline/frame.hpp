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
#include "pipeline/carry_late.hpp"
#include "pipeline/cascade.hpp"
#include "pipeline/gather.hpp"
#include "pipeline/inject.hpp"
#include "pipeline/propagate.hpp"
#include "pipeline/rasterize.hpp"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/shade.hpp"
#include "pipeline/tuning.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// The volumes of one cascade, just after its propagation.
struct CascadeVolumes {
  int cascade;
  const ClpvGrid& grid;
  const Volume& injected;
  const Volume* geometry;  ///< null without occlusion
  const Volume& accumulated;
  float light_scale;  ///< the volumes hold so many times the light
};
using CascadeObserver = std::function<void(const CascadeVolumes&)>;

/// Holds all device memory a frame needs; render() may be called again and again, for one camera or many.
class Frame {
 public:
  /// Throws Error(run_time) where the device's memory does not suffice, naming a grid that would fit.
  /// `tuning`: launch shapes of propagation, for options.layout; by default the usual ones.
  Frame(Session& session, const Scene& scene, const RenderOptions& options, const Tuning& tuning = {});
  Frame(const Frame&) = delete;  // its stages refer to its other parts
  Frame& operator=(const Frame&) = delete;

  /// Enqueues all stages, marked on the session's timeline; shaded views are there once the queue is finished.
  /// `observer` sees each cascade's volumes (and waits for the device, so leave it out of a timed frame).
  void render(const Camera& camera, const CascadeObserver& observer = {});

  /// One view of the last render, as RGBA float, row 0 on top.
  std::vector<float> read(Show view);

  const RenderOptions& options() const { return options_; }
  const Basis& basis() const { return *basis_; }
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
  void carry_late_light();

  Session& session_;
  const Scene& scene_;
  std::unique_ptr<Basis> basis_;
  RenderOptions options_;
  Transport transport_;
  SceneBuffers buffers_;
  Rasterizer rasterizer_;
  Injector injector_;
  Propagator propagator_;
  std::optional<LateCarrier> late_carrier_;  ///< none: no late light, or no coarser cascade
  Gatherer gatherer_;
  Shader shader_;
  std::optional<Surface> camera_surface_;
  std::vector<LitLight> lights_;
  std::string lit_by_;  ///< Camera::light that lights_ were prepared for
  std::vector<ClpvGrid> grids_;
  float light_scale_ = 1;  ///< what volumes hold in place of 1 W/sr
  Volume injected_;
  std::unique_ptr<Volume> geometry_;
  std::vector<std::unique_ptr<Volume>> accumulated_;
  std::vector<std::unique_ptr<Volume>> late_;  ///< a cascade; null for the finest, and without late light
  Buffer irradiance_;                          ///< float4 a pixel, as is image_
  Buffer image_;
  Show shown_ = Show::full;
};

}  // namespace clpv
