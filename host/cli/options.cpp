// SPDX-License-Identifier: MIT
#include "cli/options.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "scene/bounds.hpp"
#include "scene/view_values.hpp"
#include "support/error.hpp"
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

ClpvMedium parse_medium(const std::string& text) {
  std::string all = text;
  for (auto commas = std::ranges::count(text, ','); commas < 2; ++commas) all += ",0";
  const auto numbers = parse_numbers<double, 3>(all);
  const auto coefficient = [](double value) { return value >= 0 && value <= bounds::kExtinction; };
  if (!numbers || !coefficient((*numbers)[0]) || !coefficient((*numbers)[1]) ||
      !(std::abs((*numbers)[2]) <= bounds::kAnisotropy)) {
    throw Error(
        ExitCode::usage,
        "--medium: found '{}', allowed: scattering and absorption, 0..{:.0f} /m, and anisotropy, "
        "-{}..{}, like 0.05,0.01,0.6",
        text, bounds::kExtinction, bounds::kAnisotropy, bounds::kAnisotropy);
  }
  Medium medium{.anisotropy = (*numbers)[2]};
  medium.scattering.fill((*numbers)[0]), medium.absorption.fill((*numbers)[1]);
  return scene_medium(medium, rejected_in("--medium"));
}

CLI::Option* add_text(CLI::App& command, const OptionDescription& info,
                      const std::function<void(const std::string&)>& take) {
  return command
      .add_option_function<std::string>("--" + info.name, take,
                                        fmt::format("{} ({})", info.help, info.allowed))
      ->default_str(info.value)
      ->type_name("");
}

/// Group of a frame option in the help: those that most people need, or a stage.
std::string group_of(const std::string& name) {
  static const std::map<std::string_view, std::vector<std::string_view>> kStages{
      {"basis and tables", {"centres", "lambda", "lobe", "lobe-time", "evaluate", "table-size"}},
      {"shadow maps", {"rsm-format", "shadow-size"}},
      {"blockers", {"blocking", "blocker-stride"}},
      {"propagation", {"iterations", "directions", "coarser-directions", "layout", "storage"}},
      {"gathering", {"gather", "gather-offset", "near-size", "near-rays"}},
  };
  for (const auto& [stage, names] : kStages) {
    if (std::ranges::find(names, name) != names.end())
      return fmt::format("{}{}", kMoreOptions, stage);
  }
  return "Frame";
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

void add_frame_options(CLI::App& command, OptionValues& given) {
  for (const OptionDescription& info : list_options(RenderOptions{})) {
    if (command.get_option_no_throw("--" + info.name) != nullptr) continue;
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
  }
}

CLI::Option* add_format(CLI::App& command, std::string& format,
                        const std::vector<std::string>& formats) {
  format = formats.front();
  return command.add_option("--format", format, "format of the results on stdout")
      ->check(CLI::IsMember(formats))
      ->capture_default_str();
}

CLI::Option* add_fail_above(CLI::App& command, double& ratio) {
  return add_number(command, "--fail-above", "RATIO", ratio,
                    "exit with 5 if a value of the new report is more than RATIO times the earlier "
                    "one, beyond the "
                    "spread, or is missing, or if no row has both values",
                    {1, 1e6});
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

void SceneChanges::apply(MovingScene& scene) const {
  if (eye && target) {
    Camera given = camera;
    given.eye = *eye;
    given.target = *target;
    given.name = text_of(given);
    scene.set_cameras({scene_camera(given, rejected_in("camera"))});
  }
  if (sun) scene.set_lights({scene_light(*sun, rejected_in("--sun"))});
  if (light_scale > 0) scene.set_light_scale(light_scale);
  if (medium) scene.set_medium(*medium);
}

void SceneChanges::describe(nlohmann::json& inputs) const {
  if (sun) inputs["sun"] = fmt::format("{},{}", fmt::join(sun->direction, ","), sun->intensity[0]);
  if (light_scale > 0) inputs["light_scale"] = light_scale;
  if (medium) {
    inputs["medium"] =
        fmt::format("{},{},{}", medium->scattering[0],
                    medium->extinction[0] - medium->scattering[0], medium->anisotropy);
  }
}

void add_scene_changes(CLI::App& command, SceneChanges& changes, CLI::Option& camera) {
  constexpr const char* kGroup = "Camera and light by numbers";
  const auto vector = [&](const std::string& name, const char* type, auto& to, const char* help) {
    return command
        .add_option_function<std::string>(
            name, [&to, name](const std::string& text) { to = parse_vector(text, name); }, help)
        ->type_name(type)
        ->group(kGroup);
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
      ->needs(eye)
      ->group(kGroup);
  add_number(command, "--near-plane", "M", changes.camera.near, "its nearest visible depth [m]",
             {bounds::kMinLength, bounds::kCoordinate})
      ->needs(eye)
      ->group(kGroup);
  const auto take_sun = [&changes](const std::string& text) { changes.sun = parse_sun(text); };
  CLI::Option* sun =
      command
          .add_option_function<std::string>(
              "--sun", take_sun,
              fmt::format(
                  "direction of a sun's light and its illuminance [lx] (default: {}), in place "
                  "of all lights",
                  kSunIlluminance))
          ->type_name("X,Y,Z[,LUX]")
          ->group(kGroup);
  add_number(command, "--light-scale", "X", changes.light_scale,
             "factor of the intensities of the scene's lights (default: the scene file's, or 1); "
             "0.001464 counts lux and candela by Blender in watts",
             {1 / bounds::kLightScale, bounds::kLightScale})
      ->excludes(sun)
      ->group(kGroup);
  const auto take_medium = [&changes](const std::string& text) {
    changes.medium = parse_medium(text);
  };
  command
      .add_option_function<std::string>(
          "--medium", take_medium,
          "scattering and absorption of a medium in the scene's bounding box [1/m], and the "
          "anisotropy of its phase function (default: 0), in place of the scene's")
      ->type_name("S[,A[,G]]")
      ->group(kGroup);
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
  constexpr const char* kGroup = "Path tracing";
  add(command, "--bounces", "N|all", options.bounces,
      "maximum number of reflections between light and visible surface: 1, 2, ... or all")
      ->group(kGroup);
  auto* samples = add_number(command, "--spp", "N", options.values.samples, "paths per pixel",
                             {1, pathtracer::PathTracerOptions::kMaxSamples})
                      ->group(kGroup);
  add_number(
      command, "--noise", "X", options.values.noise,
      "relative standard error of the indirect light at which tracing stops (root mean square)",
      {kMinNoise, kMaxNoise})
      ->excludes(samples)
      ->group(kGroup);
  constexpr auto kMaxSeed = std::numeric_limits<std::uint64_t>::max();
  add_number(command, "--seed", "N", options.values.seed,
             "random seed; the same seed gives identical files",
             {0, static_cast<double>(kMaxSeed), fmt::format("0..{}", kMaxSeed)})
      ->group(kGroup);
  add_number(command, "--threads", "N", options.values.threads,
             "number of tracing threads (default: one per processor)",
             {1, pathtracer::PathTracerOptions::kMaxThreads})
      ->group(kGroup);
}

pathtracer::TraceProgress trace_progress(Progress& progress, std::uint64_t before) {
  return [&progress, before](double share) {
    progress.reach(before + static_cast<std::uint64_t>(share * kTraceSteps));
  };
}

}  // namespace clpv
