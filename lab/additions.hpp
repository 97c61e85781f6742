// SPDX-License-Identifier: MIT
#pragma once

#include "cli/commands.hpp"

namespace clpv {

/// The lab's additions to the program.
Additions lab_additions();

/// clpv-lab normals: lit surface normals of a scene, for a search for centres.
void add_normals(CLI::App& app, Shared& shared);

}  // namespace clpv
