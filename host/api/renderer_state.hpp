// SPDX-License-Identifier: MIT
// State of a Renderer, and checks of its arguments.
#pragma once

#include <fmt/format.h>

#include <map>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>

#include "api/scene_contents.hpp"
#include "clpv/renderer.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/frame/scene_options.hpp"
#include "support/error.hpp"

namespace clpv {

void check_view(View view);
/// Throws Error(usage) unless both are from 1 to 16384. `what` names them.
void check_sides(const char* what, int width, int height);
/// A camera of which only the eye counts. Throws Error(usage).
SceneCamera camera_at(const Vec3& eye);

struct Renderer::State {
  std::mutex mutex;  ///< held by each call
  Scene file;
  std::shared_lock<std::shared_mutex> scene_stays;  ///< while the frame is made
  PosedScene posed;
  RenderOptions options;
  Session session;
  std::optional<Frame> frame;
  unsigned rebuilds;                            ///< of the frame (Scene::Contents)
  std::map<std::string, std::string> metadata;  ///< of the last frame's images; empty before it
  bool lit = false;  ///< the cascades have the light of the last render() or light()
  double frame_ms = 0;

  /// `where`: a Device, or a GivenQueue.
  template <typename Where>
  State(const Scene& scene_file, const Options& given, Where where)
      : file(scene_file),
        scene_stays(file.contents().mutex),
        posed(file),
        options(resolve_options(given.given(), posed.scene())),
        session(where, ProgramCache::of_user(device_of(where))),
        rebuilds(file.contents().rebuilds) {
    frame.emplace(session, posed.scene(), options);
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

  /// Brings the scene and the frame to the time `seconds`.
  void pose(double seconds) {
    lit = false;
    const bool moved = posed.pose(seconds);
    if (rebuilds != file.contents().rebuilds) {
      metadata.clear();
      frame.emplace(session, posed.scene(), options);
      rebuilds = file.contents().rebuilds;
    } else if (moved) {
      frame->scene_moved();
    }
  }

  /// Lights pixels of the host.
  std::vector<std::array<float, 3>> light(const SceneCamera& camera, const GBuffer& surfaces);
  /// Lights pixels, as Frame::light().
  const Buffer& light(const SceneCamera& camera, const GivenPixels& pixels) {
    const Buffer& irradiance = frame->light(camera, pixels);
    lit = true;
    return irradiance;
  }

  /// Enqueues the light of pixels on the device (host/api/renderer_opencl.cpp).
  opencl::Event enqueue_light(const SceneCamera& camera, const GivenPixels& pixels,
                              const Buffer& receives);

  /// Renders a frame without an image. Sets the metadata of its images.
  /// `ahead`: does not wait for the device (Rasterizer::draw_ahead).
  void render(const CameraChoice& camera, double seconds, bool ahead = false) {
    metadata.clear();
    pose(seconds);
    frame->draw_ahead(ahead);
    const SceneCamera chosen = posed.camera(camera);
    frame->render(chosen);
    lit = true;
    for (const OptionDescription& option : list_options(options))
      metadata[option.name] = option.value;
    metadata["centres"] = std::filesystem::path(options.centres).filename().string();
    metadata["camera"] = chosen.name;
    metadata["time"] = fmt::format("{}", seconds);
  }

  Image image(View view) {
    Image made = view_image(*frame, view);
    made.metadata = metadata;
    return made;
  }
};

}  // namespace clpv
