// SPDX-License-Identifier: MIT
#include "support/cache_folder.hpp"

#include <cstdlib>

namespace clpv {

std::optional<std::filesystem::path> user_cache_folder() {
  if (const char* home = std::getenv("XDG_CACHE_HOME"); home && *home)
    return std::filesystem::path(home) / "clpv";
  if (const char* home = std::getenv("HOME"); home && *home)
    return std::filesystem::path(home) / ".cache/clpv";
  return std::nullopt;
}

}  // namespace clpv
