// SPDX-License-Identifier: MIT
#include "cli/render_request.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/options.hpp"
#include "image/image_io.hpp"
#include "options/render_options.hpp"
#include "parallel/ranks.hpp"
#include "pipeline/frame/cascade.hpp"
#include "reference/view.hpp"
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

void add_point_request(CLI::App& command, RenderRequest& request) {
  add_render_request(command, request);
  for (const char* name : {"--near-field", "--near-size", "--near-rays"})
    command.get_option(name)->group("");
}

void add_display_options(CLI::App& command, DisplayRequest& display) {
  add_number(command, "--exposure", "EV", display.exposure,
             "exposure of a PNG [EV] (default: the scene's, or automatic, by the logarithmic mean "
             "of lit pixels)",
             {-kMaxExposure, kMaxExposure});
  add_choice(command, "--tonemap", display.tonemap, "tone curve of a PNG");
  command.add_flag_callback(
      "--alpha", [&display] { display.background = Background::transparent; },
      "transparent background of a PNG (default: black)");
}

constexpr float kFaint = 15;  // [EV]; daylight in W/m^2 has -9 to 0, lamps in a room up to 6

void DisplayRequest::resolve(const SceneData& scene, bool shown,
                             const std::function<Image()>& full) {
  if (exposure && exposure != scene.exposure && !shown && full)
    log_info("--exposure has no effect on EXR files and on views without light");
  if (!exposure) exposure = scene.exposure;
  if (exposure || !shown) return;
  automatic = true;
  exposure = automatic_exposure(full());
  log_info("exposure {:.2f} EV (automatic; --exposure sets another)", *exposure);
  if (*exposure == 0)  // of an image without a lit pixel
    log_warning("the picture is black: no light reaches a surface that the camera sees");
  else if (*exposure > kFaint)
    log_warning(
        "almost no light reaches what the camera sees: the picture may show leaks and rounding");
}

Image DisplayRequest::displayed(const Image& image, Show view) const {
  const bool exposed = exposure && (!automatic || shows_light(view));
  return display_image(image, exposed ? *exposure : 0, tonemap, background);
}

void DisplayRequest::describe(nlohmann::json& inputs) const {
  inputs["exposure"] = exposure ? nlohmann::json(*exposure) : nlohmann::json("automatic");
  inputs["tonemap"] = name_of(tonemap);
  inputs["alpha"] = background == Background::transparent;
}

namespace {

bool is_png(const std::filesystem::path& output) {
  return output.extension() == ".png";
}

std::filesystem::path view_file(std::filesystem::path output, Show view, bool several) {
  if (!several) return output;
  return output.replace_extension(fmt::format(".{}{}", name_of(view), output.extension().string()));
}

}  // namespace

std::vector<NamedFile> view_files(const std::string& output, const std::vector<Show>& views) {
  require_extension("--output", output, {".exr", ".png"});
  const bool several = views.size() > 1 && is_png(output);
  std::vector<NamedFile> files;
  for (const Show view : views) files.push_back({"--output", view_file(output, view, several)});
  if (!several) files.resize(1);
  return files;
}

bool are_exposed(const std::string& output, const std::vector<Show>& views) {
  return is_png(output) && std::ranges::any_of(views, shows_light);
}

void write_views(const std::string& output, const std::vector<Show>& views,
                 const std::function<Image(Show)>& image_of, const DisplayRequest& display,
                 const std::map<std::string, std::string>& metadata) {
  const bool several = views.size() > 1;
  Image all;
  for (const Show view : views) {
    Image image = image_of(view);
    if (!is_png(output)) {
      append_layer(all, image, several ? std::string(name_of(view)) : std::string());
      continue;
    }
    image = display.displayed(image, view);
    image.metadata = metadata;
    write_png(view_file(output, view, several), image);
  }
  if (is_png(output)) return;
  all.metadata = metadata;
  write_exr(output, all);
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
    if (!value.empty()) arguments.push_back(fmt::format("{}={}", flag_of(name), value));
  };
  add("model", request.model);
  nlohmann::json changes = nlohmann::json::object();
  request.changes.describe(changes);
  for (const char* name : {"sun", "sky", "medium"})  // a camera's numbers change no kernel
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
    log_info("cascades of {:.4g} to {:.4g} m round camera '{}', cells of {:.2g} m (--cascade-size)",
             options.cascade_size, coarsest, camera.name, options.cascade_size / options.grid);
  }
  if (!cascades_meet(scene, camera.eye, options.cascades, options.cascade_size, options.grid)) {
    log_warning(
        "nothing of the scene is in the cascades, which end {:.4g} m from camera '{}': no indirect "
        "light; a larger --cascade-size or more --cascades reach farther",
        coarsest / 2, camera.name);
  }
}

nlohmann::json describe(const RenderRequest& request, const RenderOptions& options,
                        const SceneCamera& camera, double seconds) {
  nlohmann::json all = to_json(options);
  all.update({{"scene", printable(request.scene)},
              {"model", printable(request.model)},
              {"camera", camera.name},
              {"time", seconds}});
  request.display.describe(all);
  request.changes.describe(all);
  return all;
}

namespace {

constexpr double kFewUnreached = 0.001;  // ignores specks at the horizon

}  // namespace

double unreached_share(Session& session, const Frame& frame) {
  const Surface& seen = frame.seen();
  const ClpvView& view = seen.view;
  const ClpvGrid coarsest = frame.light().grids.back();
  const std::vector<float> depths =
      session.read<float>(seen.depth, std::size_t{view.width} * view.height);
  std::size_t surfaces = 0, unreached = 0;
  for (std::size_t i = 0; i < depths.size(); ++i) {
    if (depths[i] == 0) continue;
    ++surfaces;
    unreached += !reaches(coarsest, reference::surface_position(view, i, depths[i]));
  }
  return surfaces == 0 ? 0 : static_cast<double>(unreached) / static_cast<double>(surfaces);
}

void warn_of_unreached(Session& session, const Frame& frame, const std::string& camera) {
  const double share = unreached_share(session, frame);
  if (share <= kFewUnreached) return;
  log_warning(
      "camera '{}': {:.1f} % of the visible surface lies outside the cascades and has no indirect "
      "light but a sky's; a larger --cascade-size or more --cascades reach farther",
      camera, 100 * share);
}

}  // namespace clpv
