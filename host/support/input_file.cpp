// SPDX-License-Identifier: MIT
#include "support/input_file.hpp"

#include <cstdlib>
#include <fstream>

namespace clpv {

namespace fs = std::filesystem;

std::optional<std::string> file_bytes(const fs::path& path, std::uintmax_t most) {
  std::error_code failed;
  if (!fs::is_regular_file(path, failed)) return std::nullopt;
  const std::uintmax_t size = fs::file_size(path, failed);
  if (failed || size > most) return std::nullopt;
  std::ifstream in(path, std::ios::binary);
  std::string bytes(static_cast<std::size_t>(size), '\0');
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size))) return std::nullopt;
  return bytes;
}

std::optional<fs::path> user_cache_folder() {
  if (const char* home = std::getenv("XDG_CACHE_HOME"); home && *home) return fs::path(home) / "clpv";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache/clpv";
  return std::nullopt;
}

}  // namespace clpv
