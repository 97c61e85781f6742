// SPDX-License-Identifier: MIT
// A command that there is not: named, with the one that was meant.
#pragma once

#include "commands/commands.hpp"

namespace clpv {

/// Throws Error(usage) where `app` was parsed as far as finding no command, though there was a word for one: "rendr" is no
/// command; did you mean render? Without a command near, lists all there are.
void refuse_misspelt_command(const CLI::App& app);

}  // namespace clpv
