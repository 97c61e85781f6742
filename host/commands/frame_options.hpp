// SPDX-License-Identifier: MIT
// The options of a frame on the command line, from the one table in options/render_options.hpp.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "options/render_options.hpp"
#include "pipeline/given_options.hpp"

namespace clpv {

/// Adds one option of text each, but for those that `command` has already; `given` must outlive the parse.
void add_frame_options(CLI::App& command, GivenOptions& given);

/// Adds those of these names to `command`: each sets `options` as it is parsed, and shows its present value as default.
/// `options` must outlive the parse.
void add_some_frame_options(CLI::App& command, RenderOptions& options, const std::vector<std::string>& names);

/// As set_option; what it throws names the option as the command line does.
void set_given(RenderOptions& options, const std::string& name, const std::string& value);

}  // namespace clpv
