// SPDX-License-Identifier: MIT
// Where this user's caches are.
#pragma once

#include <filesystem>
#include <optional>

namespace clpv {

/// $XDG_CACHE_HOME/clpv, else $HOME/.cache/clpv; nothing where neither variable is set. Not created.
std::optional<std::filesystem::path> user_cache_folder();

}  // namespace clpv
