// SPDX-License-Identifier: MIT
// Options that several commands have, and values of several parts: choices by name, numbers in a range, vectors, boxes, and
// the options of a frame from the one table in options/render_options.hpp. What an option fills must outlive the parse.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "device/device.hpp"
#include "options/render_options.hpp"
#include "pathtracer/path_tracer.hpp"
#include "pipeline/scene_options.hpp"
#include "support/named_enum.hpp"
#include "support/progress.hpp"

namespace clpv {

/// An option with the word that stands for its value in --help, and its default where `member` holds one.
template <typename T>
CLI::Option* add(CLI::App& command, const std::string& name, const char* type, T& member,
                 const std::string& help) {
  CLI::Option* option = command.add_option(name, member, help)->type_name(type);
  if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>) {
    if (member != T{}) option->capture_default_str();
  }
  return option;
}

/// One value of an enumeration; what `member` holds is the default.
template <NamedEnum E>
CLI::Option* add_choice(CLI::App& command, const std::string& option, E& member, const std::string& help) {
  const auto take = [&member, option](const std::string& name) { member = named<E>(option, name); };
  return command.add_option_function<std::string>(option, take, help)
      ->check(CLI::IsMember(names_of<E>()))
      ->default_str(std::string(name_of(member)));
}

/// Returns an error that names the successor if a command or choice has been renamed since the last release, else "".
std::string reject_old_name(const std::string& name);

/// Adds an option that takes several values of an enumeration, separated by commas.
template <NamedEnum E>
CLI::Option* add_choices(CLI::App& command, const std::string& option, std::vector<E>& members,
                         const std::string& help) {
  const auto take = [&members, option](const std::vector<std::string>& all) {
    members.clear();
    for (const std::string& name : all) members.push_back(named<E>(option, name));
  };
  return command.add_option_function<std::vector<std::string>>(option, take, help)
      ->delimiter(',')
      ->check(reject_old_name)
      ->check(CLI::IsMember(names_of<E>()));
}

struct NumberRange {
  double least, most;
  std::string allowed;  ///< "0..1 m"
};

/// A finite number within the range. A bad value is Error(usage).
CLI::Option* add_number(CLI::App& command, const std::string& name, double& value, const std::string& help,
                        const NumberRange& range);

/// An instant or a span within those that a scene may have; what `seconds` holds is the default.
CLI::Option* add_seconds(CLI::App& command, const std::string& name, double& seconds,
                         const std::string& help);

/// Three numbers between commas. Throw Error(usage) naming the option, the text and what is allowed.
glm::dvec3 parse_dvec3(const std::string& text, const char* option);
glm::ivec3 parse_ivec3(const std::string& text, const char* option);
/// Two corners "i0,j0,k0:i1,j1,k1", the first not beyond the second.
std::pair<glm::ivec3, glm::ivec3> parse_box(const std::string& text, const char* option);

/// Adds all options of a frame, one of text each, but for those that `command` has already.
void add_frame_options(CLI::App& command, OptionValues& given);

/// Adds those of these names: each sets `options` as it is parsed, and shows its present value as default.
void add_some_frame_options(CLI::App& command, RenderOptions& options, const std::vector<std::string>& names);

/// As set_option; what it throws names the option as the command line does.
void set_given(RenderOptions& options, const std::string& name, const std::string& value);

/// "platform", "name" and "driver".
nlohmann::json to_json(const Device& device);

/// Throws Error(usage) for a file whose extension is none of these (".exr").
void require_extension(const std::string& option, const std::filesystem::path& file,
                       const std::vector<std::string>& allowed);

/// Makes the folder that an option names, where it is not there. Throws Error(run_time).
void create_folder(const std::string& option, const std::filesystem::path& folder);

/// The options of path tracing, shared by `reference`, `quality` and `report`.
struct TracingOptions {
  std::string bounces = "1";
  reference::PathTracerOptions values;  ///< all but `bounces`

  /// Throws Error(usage) for --bounces that are neither a number from 1 nor all.
  reference::PathTracerOptions resolved() const;
};

/// --bounces, --spp, --noise, --seed and --threads; `options` must outlive the parse.
void add_tracing_options(CLI::App& command, TracingOptions& options);

/// Shows on a bar what trace_paths tells it.
reference::TraceProgress shown_on(Progress& progress);
inline constexpr std::uint64_t kTraceSteps = 10000;  ///< of such a bar

}  // namespace clpv
