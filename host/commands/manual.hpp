// SPDX-License-Identifier: MIT
// The man page and the completion for bash, made from the options themselves.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace clpv {

/// roff, section 1.
std::string man_page(const CLI::App& app, const std::string& version);

/// A script that bash sources: commands, their options, and the values of those that name them ("a|b|c").
std::string bash_completion(const CLI::App& app);

}  // namespace clpv
