// SPDX-License-Identifier: MIT
#include "support/input_record.hpp"

#include <sys/stat.h>

#include <map>
#include <mutex>
#include <system_error>

namespace clpv {
namespace {

namespace fs = std::filesystem;

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
