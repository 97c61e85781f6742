// SPDX-License-Identifier: MIT
#include "commands/frame_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

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
    if (command.get_option_no_throw("--" + info.name) != nullptr) continue;
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

}  // namespace clpv
