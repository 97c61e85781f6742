// SPDX-License-Identifier: MIT
// A frame: every stage in its order, for one scene and one set of options (docs/method.md, 'The frame').
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"
#include "device/session.hpp"
#include "image/image.hpp"
#include "options/render_options.hpp"
#include "pipeline/cached.hpp"
#include "pipeline/cascade.hpp"
#include "pipeline/frame_cascades.hpp"
#include "pipeline/frame_lights.hpp"
#include "pipeline/gather.hpp"
#include "pipeline/rasterize.hpp"
#include "pipeline/scene_buffers.hpp"
#include "pipeline/shade.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Holds all device memory a frame needs; render() may be called again and again, for one camera or many.
class Frame {
 public:
  /// Throws Error(run_time) where the device's memory does not suffice.
  Frame(Session& session, const Scene& scene, const RenderOptions& options);
  Frame(const Frame&) = delete;  // its stages refer to its other parts
  Frame& operator=(const Frame&) = delete;

  /// To be called when the scene given may show another instant (MovingScene): the next frame is of that.
  void scene_moved();

  /// Enqueues the stages whose products are not there yet, marked on the session's timeline, which forgets the frame before;
  /// shaded views are there once the queue is finished. A frame is the same to the bit, whatever was rendered before it.
  /// `observer` sees each cascade's volumes (and waits for the device, so leave it out of a timed frame).
  void render(const Camera& camera, const CascadeObserver& observer = {});

  /// For benchmarks: the next frame recomputes all lighting, from shadow maps on; or everything, with what the scene's
  /// triangles block and hide.
  void forget_light() { lights_.invalidate(); }
  void invalidate();

  /// Empty before the first render.
  GatheredLight light() const { return cascades_.light(); }

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
  void rasterize_camera(const Camera& camera);
  void gather(const Surface& surface, Buffer& irradiance);

  Session& session_;
  const Scene& scene_;
  std::unique_ptr<Basis> basis_, swept_;  ///< swept_: null without a sweep
  RenderOptions options_;
  Transport transport_;
  SceneBuffers buffers_;
  Rasterizer rasterizer_;
  Gatherer gatherer_;
  Shader shader_;
  FrameLights lights_;
  FrameCascades cascades_;
  std::optional<Surface> camera_surface_;
  std::vector<Cached> packed_;  ///< accumulated light as the gatherer holds it
  Buffer irradiance_;           ///< float4 a pixel, as is image_
  Buffer image_;
  Show shown_ = Show::full;
};

/// A view of the last render as a linear image.
Image view_image(Frame& frame, Show view);

}  // namespace clpv
