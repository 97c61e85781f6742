// SPDX-License-Identifier: MIT
// Instants and spans of time on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace clpv {

/// An option of finite seconds within those that a scene may have; what `seconds` holds is the default. `seconds` must
/// outlive the parse. A bad value is Error(usage).
CLI::Option* add_seconds(CLI::App& command, const std::string& name, double& seconds,
                         const std::string& help);

}  // namespace clpv
