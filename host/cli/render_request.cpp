// SPDX-License-Identifier: MIT
#include "cli/render_request.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/options.hpp"
#include "pipeline/cascade.hpp"
#include "scene/load.hpp"
#include "support/log.hpp"

namespace clpv {

MovingScene SceneRequest::open() const {
  MovingScene moving(scene, model);
  changes.apply(moving);
  return moving;
}

void add_scene_request(CLI::App& command, SceneRequest& request) {
  command.add_option("SCENE", request.scene, "scene file (.json) or model (.gltf, .glb)")->required();
  add(command, "--model", "PATH", request.model, "model file instead of the scene file's");
  CLI::Option* camera =
      add(command, "--camera", "NAME", request.camera, "name of the camera (default: the scene's first)");
  add_scene_changes(command, request.changes, *camera);
}

void add_render_request(CLI::App& command, RenderRequest& request) {
  add_scene_request(command, request);
  add_frame_options(command, request.frame);
}

void add_shown_options(CLI::App& command, RenderRequest& request) {
  add(command, "--exposure", "EV", request.exposure, "exposure of a PNG [EV] (default: the scene's)");
  add_choice(command, "--tonemap", request.tonemap, "tone curve of a PNG");
}

void log_scene(const Scene& scene, const SceneCamera& camera, const RenderOptions& options) {
  for (const std::string& note : scene.notes) spdlog::info("{}", note);
  const double coarsest = std::ldexp(options.cascade_size, options.cascades - 1);
  if (options.cascade_size != RenderOptions{}.cascade_size && is_bare_model(scene)) {
    spdlog::info("cascades of {:.4g} to {:.4g} m round camera '{}'", options.cascade_size, coarsest,
                 camera.name);
  }
  if (!cascades_meet(scene, camera.eye, options.cascades, options.cascade_size, options.grid)) {
    spdlog::warn(
        "nothing of the scene is in the cascades, which end {:.4g} m from camera '{}': no indirect light; a "
        "larger "
        "--cascade-size or more --cascades reach farther",
        coarsest / 2, camera.name);
  }
}

nlohmann::json describe(const RenderRequest& request, const RenderOptions& options, const Scene& shown,
                        const SceneCamera& camera, double seconds) {
  nlohmann::json all = to_json(options);
  all.update({{"scene", request.scene},
              {"model", request.model},
              {"camera", camera.name},
              {"time", seconds},
              {"exposure", request.exposure_of(shown)},
              {"tonemap", name_of(request.tonemap)}});
  request.changes.describe(all);
  return all;
}

std::map<std::string, std::string> metadata_of(const nlohmann::json& described) {
  std::map<std::string, std::string> metadata;
  for (const auto& [name, value] : described.items())
    metadata[name] = value.is_string() ? value.get<std::string>() : value.dump();
  return metadata;
}

}  // namespace clpv
