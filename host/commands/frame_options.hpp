// The options of a frame on the command line, from the one table in pipeline/options.hpp.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "pipeline/options.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// What a user gave of them, by long name.
using GivenOptions = std::map<std::string, std::string>;

/// Adds one option of text each; `given` must outlive the parse.
void add_frame_options(CLI::App& command, GivenOptions& given);

/// The preset given, else the defaults; then what the scene wishes, then the other options given. Throws Error(usage) for a bad value.
RenderOptions resolve_options(const GivenOptions& given, const Scene& scene);

}  // namespace clpv
