// SPDX-License-Identifier: MIT
// Options common to commands that render frames: scene, camera, frame options and image display.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "device/session.hpp"
#include "image/image.hpp"
#include "image/tone_map.hpp"
#include "options/show.hpp"
#include "pipeline/frame/frame.hpp"
#include "scene/load.hpp"
#include "support/output_file.hpp"

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

/// Display of linear images as PNG.
struct DisplayRequest {
  ToneMap tonemap = kDisplayCurve;
  Background background = Background::black;
  std::optional<float> exposure;  ///< [EV]; empty: the scene's, or automatic
  bool automatic = false;

  /// Sets an exposure that is not given: to the scene's, or else, if `shown`, to
  /// automatic_exposure() of view full, which it logs.
  void resolve(const SceneData& scene, bool shown, const std::function<Image()>& full);
  Image displayed(const Image& image, Show view) const;
  /// Adds exposure, tone curve and background to the inputs of an image.
  void describe(nlohmann::json& inputs) const;
};

struct RenderRequest : SceneRequest {
  DisplayRequest display;
  OptionValues frame;
};

/// Files that --output names: one, or FILE.VIEW.png for each of several views. Throws Error(usage)
/// for another extension.
std::vector<NamedFile> view_files(const std::string& output, const std::vector<Show>& views);

/// Returns true if these files are PNG and show light.
bool are_exposed(const std::string& output, const std::vector<Show>& views);

/// Writes views to these files: linear layers of an EXR, or PNG. `display` must be resolved.
void write_views(const std::string& output, const std::vector<Show>& views,
                 const std::function<Image(Show)>& image_of, const DisplayRequest& display,
                 const std::map<std::string, std::string>& metadata);

/// Adds the options for scene, camera and frames.
void add_render_request(CLI::App& command, RenderRequest& request);
/// The same for points: the near field, which only pixels have, is not in its help.
void add_point_request(CLI::App& command, RenderRequest& request);

/// Adds the options for PNG files.
void add_display_options(CLI::App& command, DisplayRequest& display);

/// Returns the setup of the request's frames of `scene`. Throws Error(usage) if a given option
/// would have no effect with the others; it names both.
FrameSetup setup_of(const RenderRequest& request, const SceneData& scene);

/// Returns who compiles the kernels of frames with these options: helper processes, which get every
/// option by its value, unless a launcher started several ranks.
Compilation compilation_of(const SceneRequest& request, const RenderOptions& options,
                           const std::string& device);

/// Logs the scene's notes, the automatic choice of cascades and its consequences.
void log_scene(const SceneData& scene, const SceneCamera& camera, const RenderOptions& options);

/// Returns all inputs of an image at a time [s], by name.
nlohmann::json describe(const RenderRequest& request, const RenderOptions& options,
                        const SceneCamera& camera, double seconds);

// Surfaces that no cascade reaches.

/// Returns the share of the visible surfaces' pixels that no cascade of the last render reaches:
/// they have no indirect light. 0 without a surface.
double unreached_share(Session& session, const Frame& frame);

/// Warns above 0.1 %.
void warn_of_unreached(Session& session, const Frame& frame, const std::string& camera);

}  // namespace clpv
