// SPDX-License-Identifier: MIT
#include "support/input_file.hpp"

#include <sys/stat.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <system_error>

#include "support/error.hpp"

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

namespace {

constexpr int kMaxLinks = 40;  // symbolic links in a row, as Linux allows

struct Record {
  std::mutex mutex;  // textures are read by a thread of their own
  bool open = false;
  std::map<FileIdentity, NamedFile> files;
};

Record& record() {
  static Record made;
  return made;
}

}  // namespace

fs::path follow_links(const fs::path& path, std::error_code& error) {
  // Absolute first: weakly_canonical drops the folder of a relative path that does not exist yet.
  fs::path target = fs::weakly_canonical(fs::absolute(path, error), error);
  std::error_code missing;
  for (int hops = 0; !error && fs::is_symlink(fs::symlink_status(target, missing)); ++hops) {
    if (hops == kMaxLinks) error = std::make_error_code(std::errc::too_many_symbolic_link_levels);
    const fs::path next = error ? fs::path() : fs::read_symlink(target, error);
    if (!error) target = fs::weakly_canonical(target.parent_path() / next, error);
  }
  return target;
}

FileIdentity identity_of(const fs::path& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) == 0) return {found.st_dev, found.st_ino, {}};
  std::error_code unknown;
  const fs::path target = follow_links(path, unknown);
  if (::stat(target.parent_path().c_str(), &found) != 0) return {0, 0, target.string()};
  return {found.st_dev, found.st_ino, target.filename().string()};
}

InputRecord::InputRecord() {
  const std::lock_guard lock(record().mutex);
  record().open = true;
}

InputRecord::~InputRecord() {
  const std::lock_guard lock(record().mutex);
  record().open = false;
  record().files.clear();
}

void InputRecord::add(const NamedFile& input) {
  const std::lock_guard lock(record().mutex);
  if (record().open && !input.path.empty())
    record().files.try_emplace(identity_of(input.path), input);
}

std::optional<NamedFile> InputRecord::find(const FileIdentity& file) {
  const std::lock_guard lock(record().mutex);
  const auto found = record().files.find(file);
  return found == record().files.end() ? std::nullopt : std::optional(found->second);
}

void InputRecord::close() {
  const std::lock_guard lock(record().mutex);
  record().open = false;
}

}  // namespace clpv
