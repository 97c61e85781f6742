// SPDX-License-Identifier: MIT
// A frame: runs all pipeline stages in order, for one scene and one set of options (docs/method.md,
// 'The frame').
#pragma once

#include <optional>
#include <vector>

#include "device/session.hpp"
#include "image/image.hpp"
#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame_cascades.hpp"
#include "pipeline/frame/frame_lights.hpp"
#include "pipeline/frame/frame_setup.hpp"
#include "pipeline/gather/gather.hpp"
#include "pipeline/gather/medium.hpp"
#include "pipeline/gather/near.hpp"
#include "pipeline/raster/given_surface.hpp"
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/scene_buffers.hpp"
#include "pipeline/raster/shade.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Holds all device memory of a frame. Call render() any number of times, for one or several
/// cameras.
class Frame {
 public:
  /// Throws Error(device) for volumes too large for the device, and Error(run_time) if device
  /// memory does not suffice.
  Frame(Session& session, const SceneData& scene, FrameSetup setup);
  /// The same; also throws as FrameSetup.
  Frame(Session& session, const SceneData& scene, const RenderOptions& options);
  Frame(const Frame&) = delete;  // stages hold references to other members
  Frame& operator=(const Frame&) = delete;

  /// Call when the scene may have changed its time (MovingScene). The next frame shows the new
  /// time.
  void scene_moved();

  /// Enqueues the stages whose results are not cached. Clears the session's timeline and records
  /// the stages on it. Shaded views are complete once the queue has finished. The result is
  /// bit-identical whatever was rendered before. `observer` receives the volumes of each cascade.
  /// It waits for the device, so omit it in timed frames.
  void render(const SceneCamera& camera, const CascadeObserver& observer = {});

  /// Enqueues the light of cascades about the camera's eye, as render() without an image. Throws
  /// Error(usage) with option blockers `seen`, which needs a camera's G-buffer.
  void update(const SceneCamera& camera);

  /// Enqueues the irradiance of indirect light, with the near field, on surfaces that a caller
  /// gives, from cascades about the camera's eye. As render(), but makes no image. Returns float4
  /// per pixel [W/m^2], 0 without a surface; valid until the next call. Throws as update().
  const Buffer& light(const SceneCamera& camera, const GivenPixels& pixels);

  /// Changes the size of images. The next render() is that of a Frame of this size.
  void resize(int width, int height);

  /// For benchmarks. After invalidate_light() the next frame recomputes all lighting, including
  /// shadow maps and what rays of the near field hit. After invalidate() it recomputes everything,
  /// including blockers and visibility.
  void invalidate_light();
  void invalidate();

  /// Light of the last render(), update() or light(camera, pixels); empty before the first one.
  GatheredLight light() const { return cascades_.light(); }

  /// G-buffer of the last render's camera. Undefined before the first render.
  const Surface& seen() const { return *camera_surface_; }

  /// Rasterizer::draw_ahead() of the next frames. With one lane they always are: a GPU would wait
  /// for the host's next launch after each of its waits.
  void draw_ahead(bool ahead) { rasterizer_.draw_ahead(ahead || session_.device().lanes == 1); }

  /// Irradiance [W/m^2] from the last render's light on arbitrary surfaces, in the format of
  /// Gatherer, without the near field.
  std::vector<float> irradiance_on(const SurfaceImage& surfaces);
  /// The same at points: position [m] and unit normal of each; one value per point. Throws
  /// Error(usage) before the first render.
  std::vector<glm::vec4> irradiance_at(std::vector<glm::vec4> positions,
                                       std::vector<glm::vec4> normals);
  /// Radiance [W/m^2/sr] at positions [m], of light that travels along the unit vector of each; may
  /// be negative. Throws Error(usage) before the first render, without a sweep, and if gathering
  /// reads images.
  std::vector<glm::vec4> radiance_at(std::vector<glm::vec4> positions,
                                     std::vector<glm::vec4> directions);

  /// The text for lookups by a caller's kernel (kernels/gather/lookup.h). Throws Error(usage) for
  /// options as radiance_at().
  std::string lookup_source() const;
  /// Throws Error(usage) if the options exclude lookups; the message begins with `what`.
  void require_lookups(const char* what) const;
  /// Has the packed volumes of the last render() or light(), if lookup_source() does not throw.
  const Gatherer& gatherer() const { return gatherer_; }

  /// RSMs of a cascade of the last render, flux in W.
  std::vector<SurfaceImage> read_rsms(int cascade);

  /// One view of the last render as RGBA float, top row first.
  std::vector<float> read(Show view);

  /// One view of the last render on the device, float4 per pixel, without what read() paints: sky
  /// and cells.
  const Buffer& image(Show view);
  const Buffer& irradiance() const { return irradiance_; }

  const RenderOptions& options() const { return setup_.options; }
  const Basis& basis() const { return *setup_.basis; }        ///< basis of injected light
  const Basis& gathered() const { return *setup_.gathered; }  ///< basis of gathered light

 private:
  template <typename Stage>
  void timed(Pass pass, const Stage& stage) {
    const StageScope scope(session_, {pass});
    stage();
  }
  std::vector<ClpvGrid> grids_about(const glm::vec3& eye) const;
  /// Gathers the light of the cascades on a surface. `rays`: key of what the near field's rays
  /// depend on.
  void gather(const Surface& surface, CacheKey rays, Buffer& irradiance);
  void rasterize_camera(const SceneCamera& camera);
  void make_images();
  /// Sets up the near field to trace one of `step` x `step` camera pixels.
  void prepare_near(int step);
  void enqueue_light(const SceneCamera& camera);
  void require_light(const char* what) const;
  /// Key of what the near field's rays depend on.
  CacheKey seen_by_rays(const std::vector<ClpvGrid>& grids) const;
  void show(Show view);

  Session& session_;
  const SceneData& scene_;
  FrameSetup setup_;
  SceneBuffers buffers_;
  Rasterizer rasterizer_;
  Gatherer gatherer_;
  Shader shader_;
  std::optional<NearField> near_;      ///< none: off
  int near_step_, light_step_;         ///< step of near_; step of light()
  std::optional<MediumLight> medium_;  ///< none: no medium
  FrameLights lights_;
  FrameCascades cascades_;
  std::optional<Surface> camera_surface_;
  std::optional<Kernel> radiance_;  ///< kernel of radiance_at(), built when it is first called
  GivenSurface given_{session_};    ///< surface of light()
  Buffer given_irradiance_;
  Cached near_hits_;   ///< hits of near_
  Buffer irradiance_;  ///< float4 per pixel, like image_
  Buffer image_;
  Show shown_ = Show::full;
};

/// Returns a view of the last render as a linear image.
Image view_image(Frame& frame, Show view);

}  // namespace clpv
