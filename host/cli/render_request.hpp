// SPDX-License-Identifier: MIT
// What commands that render frames are asked for alike: a scene, a camera, options, and how images show it.
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
#include "pipeline/frame.hpp"

namespace clpv {

struct RenderRequest {
  std::string scene, model, camera;
  ToneMap tonemap = ToneMap::aces;
  std::optional<float> exposure;
  OptionValues frame;

  float exposure_of(const Scene& shown) const { return exposure.value_or(shown.exposure); }
};

/// The scene, its camera and all options of frames; the request must outlive the parse, as below.
void add_render_request(CLI::App& command, RenderRequest& request);

/// How images show it.
void add_shown_options(CLI::App& command, RenderRequest& request);

/// The scene's notes, and what was chosen of cascades in place of the user and what will come of it.
void tell_of_scene(const Scene& scene, const Camera& camera, const RenderOptions& options);

/// All that shaped an image of `shown` at an instant [s], by name.
nlohmann::json describe(const RenderRequest& request, const RenderOptions& options, const Scene& shown,
                        const Camera& camera, double seconds);

/// The same as an image holds it.
std::map<std::string, std::string> metadata_of(const nlohmann::json& described);

}  // namespace clpv
