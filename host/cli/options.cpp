// SPDX-License-Identifier: MIT
#include "cli/options.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "scene/bounds.hpp"
#include "scene/sky.hpp"
#include "scene/view_values.hpp"
#include "support/error.hpp"
#include "support/log.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

// A smaller noise takes more paths than there may be; a larger one is none.
constexpr double kMinNoise = 1e-9, kMaxNoise = 1e9;

/// Parses a direction and an optional illuminance [lx].
Light parse_sun(const std::string& text) {
  const bool has_lux = std::ranges::count(text, ',') == 3;
  const auto numbers =
      parse_numbers<double, 4>(has_lux ? text : fmt::format("{},{}", text, kSunIlluminance));
  if (!numbers) {
    throw Error(ExitCode::usage,
                "--sun: found '{}', allowed: a direction and an illuminance [lx] like 1,-3,0.5,10",
                text);
  }
  Light sun;
  sun.name = "sun";
  std::copy_n(numbers->begin(), 3, sun.direction.begin());
  sun.intensity.fill(numbers->back());
  return sun;
}

/// Reads a radiance above the horizon, with black ground, or a map.
Sky parse_sky(const std::string& text) {
  if (const auto radiance = parse_numbers<double, 3>(text)) {
    for (const double value : *radiance) {
      if (value < 0 || value > bounds::kSkyRadiance)
        throw Error(ExitCode::usage, "--sky: found '{}', allowed: radiances 0..{:g} W/m^2/sr", text,
                    bounds::kSkyRadiance);
    }
    return sky_with_ground(glm::vec3((*radiance)[0], (*radiance)[1], (*radiance)[2]), glm::vec3(0));
  }
  std::error_code unknown;
  if (std::filesystem::exists(text, unknown)) return read_sky(text, 1, 0);
  throw Error(ExitCode::usage,
              "--sky: found '{}', allowed: a radiance like 2,3,4, or an existing .exr or .hdr",
              text);
}

ClpvMedium parse_medium(const std::string& text) {
  std::string all = text;
  for (auto commas = std::ranges::count(text, ','); commas < 2; ++commas) all += ",0";
  const auto numbers = parse_numbers<double, 3>(all);
  if (!numbers)
    throw Error(ExitCode::usage,
                "--medium: found '{}', allowed: scattering, absorption [1/m] and anisotropy, like "
                "0.05,0.01,0.6",
                text);
  Medium medium{.anisotropy = (*numbers)[2]};
  medium.scattering.fill((*numbers)[0]), medium.absorption.fill((*numbers)[1]);
  return scene_medium(medium, rejected_in("--medium"));
}

CLI::Option* add_text(CLI::App& command, const OptionDescription& info,
                      const std::function<void(const std::string&)>& take) {
  return command
      .add_option_function<std::string>(flag_of(info.name), take,
                                        info.name == "preset"  // its help has the values
                                            ? info.help
                                            : fmt::format("{} ({})", info.help, info.allowed))
      ->default_str(info.value)
      ->type_name("");
}

/// Names of options and commands' options, by group of the help.
using Groups = std::vector<std::pair<std::string_view, std::vector<std::string_view>>>;

/// Group that has a name; `otherwise` if none has it.
std::string group_with(const Groups& groups, const std::string& name, const char* otherwise) {
  for (const auto& [group, names] : groups)
    if (std::ranges::find(names, name) != names.end()) return std::string(group);
  return otherwise;
}

/// Group of a frame option in the help: those that most people need, or a stage.
std::string group_of(const std::string& name) {
  static const Groups kStages{
      {"basis and tables", {"centres", "lambda", "lobe", "lobe-time", "evaluate", "table-size"}},
      {"shadow maps", {"rsm-format", "shadow-size"}},
      {"blockers", {"blocking", "blocker-stride"}},
      {"propagation",
       {"iterations", "directions", "coarser-directions", "bounce-sweeps", "layout", "storage"}},
      {"gathering", {"gather", "gather-offset", "near-size", "near-rays"}},
  };
  const std::string stage = group_with(kStages, name, "");
  return stage.empty() ? "Quality" : std::string(kMoreOptions) + stage;
}

}  // namespace

CLI::Option* add_seconds(CLI::App& command, const std::string& name, double& seconds,
                         const std::string& help) {
  const NumberRange range{-bounds::kSeconds, bounds::kSeconds,
                          fmt::format("{}..{} seconds", -bounds::kSeconds, bounds::kSeconds)};
  return add_number(command, name, "SECONDS", seconds, help, range)
      ->default_str(fmt::format("{}", seconds));
}

Vec3 parse_vector(const std::string& text, const std::string& option) {
  if (const auto v = parse_numbers<double, 3>(text)) return *v;
  throw Error(ExitCode::usage, "{}: '{}' is not three finite numbers between commas, like 0,0.5,-1",
              option, text);
}

void add_size(CLI::App& command, const std::function<void(int, int)>& take) {
  const auto parse = [take](const std::string& text) {
    const std::size_t by = text.find('x');
    const auto width = parse_number<int>(text.substr(0, by)),
               height = parse_number<int>(by == std::string::npos ? "" : text.substr(by + 1));
    const auto fits = [](std::optional<int> side) {
      return side && *side >= 1 && *side <= kMaxPixels;
    };
    if (!fits(width) || !fits(height))
      throw Error(ExitCode::usage,
                  "--size: found '{}', allowed: WIDTHxHEIGHT of 1..{}, like 960x540", text,
                  kMaxPixels);
    take(*width, *height);
  };
  command.add_option_function<std::string>("--size", parse, "image width and height [pixels]")
      ->type_name("WxH")
      ->excludes(command.get_option("--width"))
      ->excludes(command.get_option("--height"));
}

void add_frame_options(CLI::App& command, OptionValues& given) {
  for (const OptionDescription& info : list_options(RenderOptions{})) {
    const std::string flag = flag_of(info.name);
    if (command.get_option_no_throw(flag) != nullptr) continue;
    const auto take = [&given, name = info.name](const std::string& text) {
      RenderOptions probe;
      try {
        set_option(probe, name, text);  // rejects bad values before any scene is read
      } catch (const Error& error) {
        throw Error(error.code(), "--{}", error.what());
      }
      given[name] = text;
    };
    add_text(command, info, take)->group(group_of(info.name));
    if (info.name != "near") continue;
    const auto take_old = [take](const std::string& text) {
      log_warning("--near: its name is now --near-field; the next version has only that");
      take(text);
    };
    command.add_option_function<std::string>("--near", take_old)->group("");
  }
  add_size(command, [&given](int width, int height) {
    given["width"] = std::to_string(width);
    given["height"] = std::to_string(height);
  });
}

void group_options(CLI::App& command) {
  static const Groups kGroups{
      {"Input", {"model", "time", "points", "layer"}},
      {"Camera", {"camera", "eye", "target", "up", "fov", "near-plane"}},
      {"Light", {"sun", "sky", "light-scale", "medium", "direct"}},
      {"Method", {"basis", "transport", "bounces", "blockers", "near-field"}},
      {"Output",
       {"output", "view", "exposure", "tonemap", "alpha", "stats", "frames", "format", "width",
        "height", "size", "fps", "from", "video"}},
      {"Quality", {"spp", "noise", "seed", "threads"}},
  };
  for (CLI::Option* option : command.get_options()) {
    const std::string was = option->get_group();
    if (option->get_lnames().empty() || was.empty() || was.starts_with(kMoreOptions)) continue;
    option->group(group_with(kGroups, option->get_lnames()[0], was.c_str()));
  }
}

CLI::Option* add_format(CLI::App& command, std::string& format,
                        const std::vector<std::string>& formats) {
  format = formats.front();
  return command.add_option("--format", format, "format of the results on stdout")
      ->check(CLI::IsMember(formats))
      ->capture_default_str();
}

void require_extension(const std::string& option, const std::filesystem::path& file,
                       const std::vector<std::string>& allowed) {
  if (std::ranges::count(allowed, file.extension().string()) > 0) return;
  throw Error(ExitCode::usage, "{} {}: found extension '{}', allowed: {}", option, file.string(),
              file.extension().string(), fmt::join(allowed, ", "));
}

void create_folder(const std::string& option, const std::filesystem::path& folder) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw Error(ExitCode::run_time, "{} {}: {}", option, folder.string(), failed.message());
}

OutputFolder::OutputFolder(const std::string& option, const std::filesystem::path& folder) {
  std::error_code failed;
  for (std::filesystem::path missing = folder;
       !missing.empty() && !std::filesystem::exists(missing, failed);
       missing = missing.parent_path())
    created_.push_back(missing);
  try {
    create_folder(option, folder);
  } catch (const Error&) {
    remove_empty();
    throw;
  }
}

void OutputFolder::remove_empty() {
  std::error_code used;
  for (const std::filesystem::path& folder : created_) std::filesystem::remove(folder, used);
}

void SceneChanges::apply(MovingScene& scene) const {
  if (eye && target) {
    Camera given = camera;
    given.eye = *eye;
    given.target = *target;
    given.name = text_of(given);
    scene.set_cameras({scene_camera(given, rejected_in("camera"))});
  }
  if (sun) scene.set_lights({scene_light(*sun, rejected_in("--sun"))});
  if (no_sun) scene.set_lights({});
  if (!sky.empty()) scene.set_sky(std::make_shared<const Sky>(parse_sky(sky)));
  if (light_scale > 0) scene.set_light_scale(light_scale);
  if (medium) scene.set_medium(*medium);
}

void SceneChanges::describe(nlohmann::json& inputs) const {
  if (sun) inputs["sun"] = fmt::format("{},{}", fmt::join(sun->direction, ","), sun->intensity[0]);
  if (no_sun) inputs["sun"] = "off";
  if (!sky.empty()) inputs["sky"] = printable(sky);
  if (light_scale > 0) inputs["light_scale"] = light_scale;
  if (medium) {
    inputs["medium"] =
        fmt::format("{},{},{}", medium->scattering[0],
                    medium->extinction[0] - medium->scattering[0], medium->anisotropy);
  }
}

void add_scene_changes(CLI::App& command, SceneChanges& changes, CLI::Option& camera) {
  const auto vector = [&](const std::string& name, const char* type, auto& to, const char* help) {
    return command
        .add_option_function<std::string>(
            name, [&to, name](const std::string& text) { to = parse_vector(text, name); }, help)
        ->type_name(type);
  };
  CLI::Option* eye =
      vector("--eye", "X,Y,Z", changes.eye, "position of a camera [m], in place of --camera");
  eye->excludes(&camera);
  CLI::Option* target =
      vector("--target", "X,Y,Z", changes.target, "point that this camera looks at [m]");
  target->needs(eye);
  eye->needs(target);
  vector("--up", "X,Y,Z", changes.camera.up, "its upward direction (default: 0,1,0)")->needs(eye);
  add_number(command, "--fov", "DEGREES", changes.camera.vertical_fov_degrees,
             "its vertical field of view [degrees]", {bounds::kMinFov, bounds::kMaxFov})
      ->needs(eye);
  add_number(command, "--near-plane", "M", changes.camera.near, "its nearest visible depth [m]",
             {bounds::kMinLength, bounds::kCoordinate})
      ->needs(eye);
  const auto take_sun = [&changes](const std::string& text) {
    changes.no_sun = text == "off";
    if (!changes.no_sun) changes.sun = parse_sun(text);
  };
  CLI::Option* sun =
      command
          .add_option_function<std::string>(
              "--sun", take_sun,
              fmt::format(
                  "direction of a sun's light and its illuminance [lx] (default: {}), in place "
                  "of all lights; off: no lights",
                  kSunIlluminance))
          ->type_name("X,Y,Z[,LUX]|off");
  add(command, "--sky", "R,G,B|FILE", changes.sky,
      "radiance of a sky above the horizon [W/m^2/sr], or a map (.exr, .hdr), in place of the "
      "scene's");
  add_number(command, "--light-scale", "X", changes.light_scale,
             "factor of the intensities of the scene's lights (default: the scene file's, or 1); "
             "0.001464 converts Blender's lux and candela to watts",
             {1 / bounds::kLightScale, bounds::kLightScale})
      ->excludes(sun);
  const auto take_medium = [&changes](const std::string& text) {
    changes.medium = parse_medium(text);
  };
  command
      .add_option_function<std::string>(
          "--medium", take_medium,
          "scattering and absorption of a medium in the scene's bounding box [1/m], and the "
          "anisotropy of its phase function (default: 0), in place of the scene's")
      ->type_name("S[,A[,G]]");
}

pathtracer::PathTracerOptions TracingOptions::resolved() const {
  pathtracer::PathTracerOptions result = values;
  if (bounces == "all") {
    result.bounces = pathtracer::PathTracerOptions::kAllBounces;
  } else {
    result.bounces = parse_number<int>(bounces).value_or(0);
    if (result.bounces < 1)
      throw Error(ExitCode::usage, "--bounces {}: allowed: a number from 1, or all", bounces);
  }
  return result;
}

void add_tracing_options(CLI::App& command, TracingOptions& options) {
  add(command, "--bounces", "N|all", options.bounces,
      "maximum number of reflections between light and visible surface: 1, 2, ... or all");
  auto* samples = add_number(command, "--spp", "N", options.values.samples, "paths per pixel",
                             {1, pathtracer::PathTracerOptions::kMaxSamples});
  add_number(
      command, "--noise", "X", options.values.noise,
      "relative standard error of the indirect light at which tracing stops (root mean square)",
      {kMinNoise, kMaxNoise})
      ->excludes(samples);
  constexpr auto kMaxSeed = std::numeric_limits<std::uint64_t>::max();
  add_number(command, "--seed", "N", options.values.seed,
             "random seed; the same seed gives identical files",
             {0, static_cast<double>(kMaxSeed), fmt::format("0..{}", kMaxSeed)});
  add_number(command, "--threads", "N", options.values.threads,
             "number of tracing threads (default: one per processor)",
             {1, pathtracer::PathTracerOptions::kMaxThreads});
}

pathtracer::TraceProgress trace_progress(Progress& progress, std::uint64_t before) {
  return [&progress, before](double share) {
    progress.reach(before + static_cast<std::uint64_t>(share * kTraceSteps));
  };
}

}  // namespace clpv
