// SPDX-License-Identifier: MIT
// Options common to commands that render frames: scene, camera, frame options and image display.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "image/image.hpp"
#include "image/tone_map.hpp"
#include "pipeline/frame/frame.hpp"
#include "scene/load.hpp"

namespace clpv {

/// Scene, camera and sun, as given on the command line.
struct SceneRequest {
  std::string scene, model, camera;
  SceneChanges changes;

  /// Loads the scene with these changes. A camera given by its numbers is then the only one.
  MovingScene open() const;
};

/// Adds SCENE, --model, --camera and the options of add_scene_changes(); the request must outlive
/// the parse, as below.
void add_scene_request(CLI::App& command, SceneRequest& request);

struct RenderRequest : SceneRequest {
  ToneMap tonemap = ToneMap::aces;
  Background background = Background::black;
  std::optional<float> exposure;
  OptionValues frame;

  float exposure_of(const SceneData& shown) const { return exposure.value_or(shown.exposure); }
  Image displayed(const Image& image, float ev) const {
    return display_image(image, ev, tonemap, background);
  }
};

/// Adds the options for scene, camera and frames.
void add_render_request(CLI::App& command, RenderRequest& request);

/// Adds the options for image display.
void add_shown_options(CLI::App& command, RenderRequest& request);

/// Returns the setup of the request's frames of `scene`. Throws Error(usage) if a given option
/// would have no effect with the others; it names both.
FrameSetup setup_of(const RenderRequest& request, const SceneData& scene);

/// Returns who compiles the kernels of frames with these options: helper processes, which get every
/// option by its value, unless a launcher started several ranks.
Compilation compilation_of(const SceneRequest& request, const RenderOptions& options,
                           const std::string& device);

/// Logs the scene's notes, the automatic choice of cascades and its consequences.
void log_scene(const SceneData& scene, const SceneCamera& camera, const RenderOptions& options);

/// Returns all inputs of an image of `shown` at a time [s], by name.
nlohmann::json describe(const RenderRequest& request, const RenderOptions& options,
                        const SceneData& shown, const SceneCamera& camera, double seconds);

}  // namespace clpv
