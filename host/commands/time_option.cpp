// SPDX-License-Identifier: MIT
#include "commands/time_option.hpp"

#include <fmt/format.h>

#include "scene/bounds.hpp"
#include "support/error.hpp"
#include "support/text.hpp"

namespace clpv {

CLI::Option* add_seconds(CLI::App& command, const std::string& name, double& seconds,
                         const std::string& help) {
  const auto take = [&seconds, name](const std::string& text) {
    const auto value = parse_number<double>(text);
    if (!value || !(*value >= -bounds::kSeconds && *value <= bounds::kSeconds)) {  // NaN is in no range
      throw Error(ExitCode::usage, "{}: found '{}', allowed: {}..{} seconds", name, text, -bounds::kSeconds,
                  bounds::kSeconds);
    }
    seconds = *value;
  };
  return command.add_option_function<std::string>(name, take, help)
      ->type_name("SECONDS")
      ->default_str(fmt::format("{}", seconds));
}

}  // namespace clpv
