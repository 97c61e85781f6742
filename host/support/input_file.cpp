// SPDX-License-Identifier: MIT
#include "support/input_file.hpp"

#include <cstdlib>
#include <fstream>

#include "support/error.hpp"
#include "support/input_record.hpp"

namespace clpv {

namespace fs = std::filesystem;

namespace {

Bytes bytes_of(const fs::path& path, std::uint64_t limit, const std::string& file,
               std::string_view place) {
  std::error_code failure;
  const fs::file_status status = fs::status(path, failure);
  if (!fs::exists(status))
    reject(file, place, fmt::format("no file '{}'", path.string()), "an existing file");
  if (!fs::is_regular_file(status)) {
    reject(file, place,
           fmt::format("'{}', {}", path.string(),
                       fs::is_directory(status) ? "a folder" : "not a regular file"),
           "a regular file");
  }
  const std::uint64_t size = fs::file_size(path, failure);
  if (failure || size > limit) {
    reject(file, place, fmt::format("'{}' of {} bytes", path.string(), size),
           fmt::format("at most {} bytes", limit));
  }
  Bytes bytes(size);
  std::ifstream stream(path, std::ios::binary);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!stream || static_cast<std::uint64_t>(stream.gcount()) != size) {
    reject(file, place, fmt::format("'{}', which cannot be read", path.string()),
           "a readable file");
  }
  return bytes;
}

}  // namespace

Bytes read_file(const fs::path& path, std::uint64_t limit, const std::string& file,
                std::string_view place) {
  InputRecord::add({place.empty() ? "an input," : fmt::format("{} {}", file, place), path});
  return bytes_of(path, limit, file, place);
}

std::optional<std::string> file_bytes(const fs::path& path, std::uintmax_t max_bytes) {
  try {
    const Bytes bytes = bytes_of(path, max_bytes, path.string(), {});
    return std::string(bytes.begin(), bytes.end());
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::optional<fs::path> user_cache_folder() {
  // A relative path would be a folder of whatever folder is the current one.
  const auto absolute = [](const char* variable) {
    const char* set = std::getenv(variable);
    return set != nullptr && *set == '/' ? std::optional<fs::path>(set) : std::nullopt;
  };
  if (const auto cache = absolute("XDG_CACHE_HOME")) return *cache / "clpv";
  if (const auto home = absolute("HOME")) return *home / ".cache/clpv";
  return std::nullopt;
}

}  // namespace clpv
