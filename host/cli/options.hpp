// SPDX-License-Identifier: MIT
// Options of several commands, and structured values: named choices, numbers in a range, vectors,
// and the frame options of options/render_options.hpp. The target variable of an option must
// outlive the parse.
#pragma once

#include <CLI/CLI.hpp>
#include <concepts>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "clpv/scene.hpp"
#include "device/device.hpp"
#include "options/render_options.hpp"
#include "options/scene_options.hpp"
#include "pathtracer/path_tracer.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"
#include "support/progress.hpp"
#include "support/text.hpp"

namespace clpv {

/// Adds an option of text with the placeholder of its value in --help, and its default if `member`
/// holds one.
template <typename T>
CLI::Option* add(CLI::App& command, const std::string& name, const char* type, T& member,
                 const std::string& help) {
  static_assert(!std::is_arithmetic_v<T>, "add_number() reads numbers");
  CLI::Option* option = command.add_option(name, member, help)->type_name(type);
  if (name.starts_with('-')) {
    option->check([](const std::string& value) {
      return value.starts_with("--") ? fmt::format("found the option {}, allowed: a value", value)
                                     : std::string();
    });
  }
  if constexpr (std::is_same_v<T, std::string>) {
    if (member != T{}) option->capture_default_str();
  }
  return option;
}

/// Adds an option that takes one value of an enumeration; the value of `member` is the default.
template <NamedEnum E>
CLI::Option* add_choice(CLI::App& command, const std::string& option, E& member,
                        const std::string& help) {
  const auto take = [&member, option](const std::string& name) { member = named<E>(option, name); };
  return command.add_option_function<std::string>(option, take, help)
      ->check(CLI::IsMember(names_of<E>()))
      ->default_str(std::string(name_of(member)));
}

/// Adds an option that takes several values of an enumeration, separated by commas.
template <NamedEnum E>
CLI::Option* add_choices(CLI::App& command, const std::string& option, std::vector<E>& members,
                         const std::string& help,
                         const std::vector<std::string>& allowed = names_of<E>()) {
  const auto take = [&members, option](const std::vector<std::string>& all) {
    members.clear();
    for (const std::string& name : all) members.push_back(named<E>(option, name));
  };
  return command.add_option_function<std::vector<std::string>>(option, take, help)
      ->delimiter(',')
      ->check(CLI::IsMember(allowed));
}

struct NumberRange {
  double minimum, maximum;
  std::string allowed = {};  ///< "0..1 m"; empty: "MINIMUM..MAXIMUM"
};

/// Parses the value of an option, a number within the range. Throws Error(usage) that names option,
/// value and range.
template <typename Number>
Number option_number(const std::string& option, const std::string& text, const NumberRange& range) {
  const auto found = parse_number<Number>(text);
  const auto value = static_cast<double>(found.value_or(0));
  if (found && value >= range.minimum && value <= range.maximum) return *found;
  throw Error(
      ExitCode::usage, "{}: found '{}', allowed: {}", option, text,
      range.allowed.empty() ? fmt::format("{}..{}", range.minimum, range.maximum) : range.allowed);
}

/// Adds an option of a number within the range, a member of type Number or of an optional one. Its
/// value is the default in --help unless it is 0. All numeric options are added here, since CLI11
/// accepts NaN, and reads 010 as 8.
template <typename Member>
CLI::Option* add_number(CLI::App& command, const std::string& name, const char* type,
                        Member& member, const std::string& help, const NumberRange& range) {
  const auto take = [&member, name, range](const std::string& text) {
    if constexpr (std::is_arithmetic_v<Member>) {
      member = option_number<Member>(name, text, range);
    } else {
      using Number = typename Member::value_type;
      static_assert(std::is_same_v<Member, std::optional<Number>>);
      member = option_number<Number>(name, text, range);
    }
  };
  CLI::Option* option = command.add_option_function<std::string>(name, take, help)->type_name(type);
  if constexpr (std::is_arithmetic_v<Member>) {
    if (member != Member{}) option->default_str(fmt::format("{}", member));
  }
  return option;
}

/// Adds an option for a time [s] within the range of scenes; the value of `seconds` is the default.
CLI::Option* add_seconds(CLI::App& command, const std::string& name, double& seconds,
                         const std::string& help);

/// Parses three comma-separated numbers. Throws Error(usage) with the option, the text and the
/// allowed form.
Vec3 parse_vector(const std::string& text, const std::string& option);

/// Prefix of the groups of options that --help leaves to --help-all.
inline constexpr std::string_view kMoreOptions = "More: ";

/// Adds all frame options as text options, except those that `command` already has.
void add_frame_options(CLI::App& command, OptionValues& given);

/// Adds --size, in place of --width and --height, which `command` already has.
void add_size(CLI::App& command, const std::function<void(int, int)>& take);

/// Moves the options of a command to the groups of its help: Input, Camera, Light, ...
void group_options(CLI::App& command);

/// Adds --format, for the results on stdout; the first of `formats` is the default.
CLI::Option* add_format(CLI::App& command, std::string& format,
                        const std::vector<std::string>& formats = {"table", "json"});

/// Throws Error(usage) unless the file has one of these extensions (".exr").
void require_extension(const std::string& option, const std::filesystem::path& file,
                       const std::vector<std::string>& allowed);

/// Creates the folder of an option if it is missing. Throws Error(run_time).
void create_folder(const std::string& option, const std::filesystem::path& folder);

/// The folder of an option: created if it is missing, and removed if it is still empty at the end
/// of the command, as after an error.
class OutputFolder {
 public:
  OutputFolder(const std::string& option, const std::filesystem::path& folder);
  ~OutputFolder() { remove_empty(); }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  void remove_empty();

  std::vector<std::filesystem::path> created_;  ///< the innermost first
};

/// A camera, a sun and a medium given by numbers, in place of the scene's; a factor of its lights.
struct SceneChanges {
  std::optional<Vec3> eye, target;  ///< both or none
  Camera camera;                    ///< its other numbers
  std::optional<Light> sun;
  bool no_sun = false;               ///< no lights but a sky and emissive surfaces
  std::string sky;                   ///< a radiance, or a file; empty: the scene's
  double light_scale = 0;            ///< 0: the scene's
  std::optional<ClpvMedium> medium;  ///< fills the scene's bounding box

  /// Throws Error(usage) for numbers that no camera or light has.
  void apply(MovingScene& scene) const;
  /// Adds sun, sky, light scale and medium to the inputs of an image; the camera's name has its
  /// numbers.
  void describe(nlohmann::json& inputs) const;
};

/// Adds --eye, --target, --up, --fov, --near-plane, --sun, --sky, --light-scale and
/// --medium. `camera`:
/// the option that excludes --eye.
void add_scene_changes(CLI::App& command, SceneChanges& changes, CLI::Option& camera);

/// The options of path tracing.
struct TracingOptions {
  std::string bounces = "all";
  pathtracer::PathTracerOptions values;  ///< all but `bounces`

  /// Throws Error(usage) unless --bounces is a number from 1 or all.
  pathtracer::PathTracerOptions resolved() const;
};

/// Adds --bounces, --spp, --noise, --seed and --threads; `options` must outlive the parse.
void add_tracing_options(CLI::App& command, TracingOptions& options);

/// Returns a callback that shows the progress of trace_paths on a bar, after `before` steps.
pathtracer::TraceProgress trace_progress(Progress& progress, std::uint64_t before = 0);
inline constexpr std::uint64_t kTraceSteps = 10000;  ///< steps of that bar

}  // namespace clpv
