// SPDX-License-Identifier: MIT
#include "cli/render_request.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/options.hpp"
#include "options/validate.hpp"
#include "parallel/ranks.hpp"
#include "pipeline/frame/cascade.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "support/log.hpp"
#include "support/named_enum.hpp"
#include "support/text.hpp"

namespace clpv {

namespace {
constexpr float kMaxExposure = 64;  // 2^64: beyond any scene, and finite
}

MovingScene SceneRequest::open() const {
  MovingScene moving(scene, model);
  changes.apply(moving);
  return moving;
}

void add_scene_request(CLI::App& command, SceneRequest& request) {
  command.add_option("SCENE", request.scene, "scene file (.json) or model (.gltf, .glb)")
      ->required();
  add(command, "--model", "PATH", request.model, "model file instead of the scene file's");
  CLI::Option* camera = add(command, "--camera", "NAME", request.camera,
                            "name of the camera (default: the scene's first)")
                            ->check([](const std::string& name) {
                              return name.empty() ? "found '', allowed: a name" : "";
                            });
  add_scene_changes(command, request.changes, *camera);
}

void add_render_request(CLI::App& command, RenderRequest& request) {
  add_scene_request(command, request);
  add_frame_options(command, request.frame);
}

void add_shown_options(CLI::App& command, RenderRequest& request) {
  add_number(command, "--exposure", "EV", request.exposure,
             "exposure of a PNG [EV] (default: the scene's)", {-kMaxExposure, kMaxExposure});
  add_choice(command, "--tonemap", request.tonemap, "tone curve of a PNG");
  command.add_flag_callback(
      "--alpha", [&request] { request.background = Background::transparent; },
      "transparent background of a PNG (default: black)");
}

FrameSetup setup_of(const RenderRequest& request, const SceneData& scene) {
  FrameSetup setup(request.frame, scene);
  try {
    reject_without_effect(request.frame, setup.options, *setup.basis);
  } catch (const Error& error) {
    throw Error(error.code(), "--{}", error.what());
  }
  return setup;
}

Compilation compilation_of(const SceneRequest& request, const RenderOptions& options,
                           const std::string& device) {
  if (launcher_rank()) return {};
  std::vector<std::string> arguments = {"prepare", request.scene};
  const auto add = [&arguments](const std::string& name, const std::string& value) {
    if (!value.empty()) arguments.push_back(fmt::format("--{}={}", name, value));
  };
  add("model", request.model);
  nlohmann::json changes = nlohmann::json::object();
  request.changes.describe(changes);
  for (const char* name : {"sun", "medium"})  // a camera's numbers change no kernel
    if (changes.contains(name)) add(name, changes[name].get<std::string>());
  add("device", device);
  for (const OptionDescription& option : list_options(options)) {
    if (option.name != "basis" || options.centres.empty()) add(option.name, option.value);
  }
  return {std::move(arguments), std::nullopt};
}

void log_scene(const SceneData& scene, const SceneCamera& camera, const RenderOptions& options) {
  for (const std::string& note : scene.notes) log_info("{}", note);
  const double coarsest = std::ldexp(options.cascade_size, options.cascades - 1);
  if (options.cascade_size != RenderOptions{}.cascade_size && is_bare_model(scene)) {
    log_info("cascades of {:.4g} to {:.4g} m round camera '{}'", options.cascade_size, coarsest,
             camera.name);
  }
  if (!cascades_meet(scene, camera.eye, options.cascades, options.cascade_size, options.grid)) {
    log_warning(
        "nothing of the scene is in the cascades, which end {:.4g} m from camera '{}': no indirect "
        "light; a larger --cascade-size or more --cascades reach farther",
        coarsest / 2, camera.name);
  }
}

nlohmann::json describe(const RenderRequest& request, const RenderOptions& options,
                        const SceneData& shown, const SceneCamera& camera, double seconds) {
  nlohmann::json all = to_json(options);
  all.update({{"scene", printable(request.scene)},
              {"model", printable(request.model)},
              {"camera", camera.name},
              {"time", seconds},
              {"exposure", request.exposure_of(shown)},
              {"tonemap", name_of(request.tonemap)},
              {"alpha", request.background == Background::transparent}});
  request.changes.describe(all);
  return all;
}

}  // namespace clpv
