// SPDX-License-Identifier: MIT
#include "commands/time_option.hpp"

#include <fmt/format.h>

#include <charconv>

#include "scene/bounds.hpp"
#include "support/error.hpp"

namespace clpv {

CLI::Option* add_seconds(CLI::App& command, const std::string& name, double& seconds,
                         const std::string& help) {
  const auto take = [&seconds, name](const std::string& text) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool number = error == std::errc{} && end == text.data() + text.size();
    if (!number || !(value >= -bounds::kSeconds && value <= bounds::kSeconds)) {  // NaN is in no range
      throw Error(ExitCode::usage, "{}: found '{}', allowed: {}..{} seconds", name, text, -bounds::kSeconds,
                  bounds::kSeconds);
    }
    seconds = value;
  };
  return command.add_option_function<std::string>(name, take, help)
      ->type_name("SECONDS")
      ->default_str(fmt::format("{}", seconds));
}

}  // namespace clpv
