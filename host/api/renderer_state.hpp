// SPDX-License-Identifier: MIT
// State of a Renderer, and checks of its arguments.
#pragma once

#include <fmt/format.h>

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>

#include "api/scene_contents.hpp"
#include "clpv/renderer.hpp"
#include "pipeline/frame/frame.hpp"
#include "support/error.hpp"

namespace clpv {

void check_view(View view);
/// Throws Error(usage) unless both are from 1 to 16384. `what` names them.
void check_sides(const char* what, int width, int height);
/// A camera of which only the eye counts. Throws Error(usage), which names the function.
SceneCamera camera_at(const char* function, const Vec3& eye);

struct Renderer::State {
  std::mutex mutex;  ///< held by each call
  Scene file;
  std::shared_lock<std::shared_mutex> scene_stays;  ///< while the frame is made
  PosedScene posed;
  OptionValues given;
  FrameSetup setup;  ///< `given` for the scene
  Session session;
  std::string description;  ///< never changes
  std::optional<Frame> frame;
  unsigned rebuilds;                            ///< the frame's (Scene::Contents)
  std::map<std::string, std::string> metadata;  ///< for the last frame's images; empty before it
  bool lit = false;  ///< the cascades have the light of the last render(), light() or update()
  struct Shown {     ///< subject of the last images
    SceneCamera camera;
    double seconds;
    unsigned changes;  ///< Scene::Contents::changes
  };
  std::optional<Shown> shown = {};
  std::optional<Shown> lit_of = {};  ///< subject of the last light
  bool lit_for_shown = false;        ///< the cascades have its light
  double posed_at = 0;               ///< time of the last pose()
  double frame_ms = 0;

  /// `where`: a Device, or a GivenQueue.
  template <typename Where>
  State(const Scene& scene_file, const Options& set, Where where)
      : file(scene_file),
        scene_stays(file.contents().mutex),
        posed(file),
        given(set.given()),
        setup(given, posed.scene()),
        session(where, ProgramCache::of_user(device_of(where))),
        rebuilds(file.contents().rebuilds) {
    frame.emplace(session, posed.scene(), setup);
    const RenderOptions& options = setup.options;
    description =
        fmt::format("{} x {}, basis {}, transport {}, on {}", options.width, options.height,
                    options.basis, name_of(options.transport), session.device().name);
    scene_stays.unlock();
  }

  static const Device& device_of(const Device& device) { return device; }
  static const Device& device_of(const GivenQueue& given) { return given.device; }

  void require(bool made, const char* what) const {
    if (!made)
      throw Error(ExitCode::usage, "{}: no frame was rendered; allowed: after a render", what);
  }
  void require_image(const char* what) const { require(!metadata.empty(), what); }
  void require_light(const char* what) const { require(lit, what); }

  /// Cells of the last images, whose light the cascades get for it where other calls gave them
  /// another.
  Image cells() {
    if (lit && lit_for_shown) return image(View::cells);
    if (shown->changes != file.contents().changes)
      throw Error(ExitCode::usage,
                  "show: found view 'cells' of a scene that changed since its render, allowed: the "
                  "other views, or after a render");
    const std::optional<Shown> before = lit ? lit_of : std::nullopt;
    update(shown->camera, shown->seconds);
    Image made = image(View::cells);
    if (before) {
      update(before->camera, before->seconds);
    } else {
      lit_for_shown = true;
    }
    return made;
  }

  /// Brings the scene and the frame to the time `seconds`, and returns the camera. Refuses both
  /// before anything changes: the last frame stays.
  SceneCamera pose(const CameraChoice& camera, double seconds) {
    posed.check(camera, seconds);
    pose(seconds);
    return posed.camera(camera);
  }
  void pose(double seconds) {
    const bool moved = posed.pose(seconds);
    posed_at = seconds;
    lit = lit_for_shown = false;
    if (!frame || rebuilds != file.contents().rebuilds) {
      metadata.clear();
      setup = FrameSetup(given, posed.scene());  // cascades may fit the scene
      frame.emplace(session, posed.scene(), setup);
      rebuilds = file.contents().rebuilds;
    } else if (moved) {
      frame->scene_moved();
    }
  }

  /// Throws Error(usage) unless cascades can have light without a frame.
  void require_light_alone() const { setup.require_own_blockers(); }

  /// Lights pixels of the host.
  std::vector<std::array<float, 3>> light(const SceneCamera& camera, const GBuffer& surfaces);
  /// Lights pixels, as Frame::light().
  const Buffer& light(const SceneCamera& camera, const GivenPixels& pixels) {
    const Buffer& irradiance = frame->light(camera, pixels);
    lit = true, lit_of = {camera, posed_at, file.contents().changes};
    return irradiance;
  }

  /// Enqueues the light of pixels on the device (host/api/renderer_opencl.cpp). `posed` poses the
  /// scene; returns the camera.
  opencl::Event enqueue_light(const opencl::GBuffer& surfaces,
                              const std::function<SceneCamera()>& posed);

  /// Lights the cascades alone.
  void update(const SceneCamera& camera, double seconds) {
    require_light_alone();
    pose(seconds);
    frame->draw_ahead(false);
    frame->update(camera);
    lit = true, lit_of = {camera, seconds, file.contents().changes};
  }

  /// Renders a frame without an image. Sets the metadata of its images.
  /// `ahead`: does not wait for the device (Rasterizer::draw_ahead).
  void render(const CameraChoice& camera, double seconds, const ImageSize& size,
              bool ahead = false) {
    const SceneCamera chosen = pose(camera, seconds);
    metadata.clear();
    frame->resize(size ? (*size)[0] : setup.options.width,
                  size ? (*size)[1] : setup.options.height);
    frame->draw_ahead(ahead);
    frame->render(chosen);
    lit = lit_for_shown = true;
    shown = {chosen, seconds, file.contents().changes};
    for (const OptionDescription& option : list_options(frame->options()))
      metadata[option.name] = option.value;
    metadata["centres"] = std::filesystem::path(setup.options.centres).filename().string();
    metadata["camera"] = chosen.name;
    metadata["time"] = fmt::format("{}", seconds);
  }

  Image image(View view) {
    Image made = view_image(*frame, view);
    made.metadata = metadata;
    made.metadata["view"] = name_of(view);
    return made;
  }
};

}  // namespace clpv
