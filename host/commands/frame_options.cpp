#include "commands/frame_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "pipeline/cascade.hpp"
#include "scene/load.hpp"
#include "support/error.hpp"

namespace clpv {

namespace {

CLI::Option* add_text(CLI::App& command, const OptionInfo& info,
                      const std::function<void(const std::string&)>& take) {
  return command
      .add_option_function<std::string>("--" + info.name, take,
                                        fmt::format("{} ({})", info.help, info.allowed))
      ->default_str(info.value)
      ->type_name("");
}

}  // namespace

void set_given(RenderOptions& options, const std::string& name, const std::string& value) {
  try {
    set_option(options, name, value);
  } catch (const Error& error) {
    throw Error(error.code(), "--{}", error.what());
  }
}

void add_frame_options(CLI::App& command, GivenOptions& given) {
  for (const OptionInfo& info : list_options(RenderOptions{})) {
    const auto take = [&given, name = info.name](const std::string& text) {
      RenderOptions probe;
      set_given(probe, name, text);  // a bad value is told before any scene is read
      given[name] = text;
    };
    add_text(command, info, take)->group("Frame");
  }
}

void add_some_frame_options(CLI::App& command, RenderOptions& options,
                            const std::vector<std::string>& names) {
  for (const OptionInfo& info : list_options(options)) {
    if (std::ranges::find(names, info.name) == names.end()) continue;
    add_text(command, info,
             [&options, name = info.name](const std::string& text) { set_given(options, name, text); });
  }
}

RenderOptions resolve_options(const GivenOptions& given, const Scene& scene) {
  RenderOptions options;
  if (const auto preset = given.find("preset"); preset != given.end())
    set_option(options, "preset", preset->second);
  if (scene.cascade_size) options.cascade_size = *scene.cascade_size;
  if (scene.cascades) options.cascades = *scene.cascades;
  if (given.contains("basis") && given.contains("centres"))
    throw Error(ExitCode::usage, "--basis and --centres are both given; allowed: one of them");
  for (const auto& [name, value] : given) {
    if (name != "preset") set_option(options, name, value);
  }
  if (is_bare_model(scene) && !given.contains("cascade-size"))
    options.cascade_size = fitting_cascade_size(scene, options.cascades, options.cascade_size);
  if (!options.centres.empty()) options.basis = make_basis(options)->name();
  return options;
}

}  // namespace clpv
