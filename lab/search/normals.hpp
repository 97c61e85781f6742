// SPDX-License-Identifier: MIT
#pragma once

#include "cli/commands.hpp"

namespace clpv {

/// clpv-lab normals: lit surface normals of a scene, for a search for centres.
void add_normals(CLI::App& app, Shared& shared);

}  // namespace clpv
