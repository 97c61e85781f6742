// SPDX-License-Identifier: MIT
#include "support/scratch_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <ctime>
#include <system_error>

#include "support/error.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPrefix = "clpv-";
constexpr std::size_t kRandom = 6;          // letters that mkdtemp chooses
constexpr std::time_t kSecondsToLock = 60;  // a younger folder may not have its lock yet

int open_folder(const fs::path& folder) {
  return ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
}

bool is_scratch(const fs::path& path) {
  const std::string name = path.filename().string();
  return name.starts_with(kPrefix) && name.size() == std::string(kPrefix).size() + kRandom;
}

/// Removes the scratch folders in `above` whose process has ended without removing them.
void remove_abandoned(const fs::path& above) {
  std::error_code error;
  for (fs::directory_iterator it(above, error), end; !error && it != end; it.increment(error)) {
    if (!is_scratch(it->path())) continue;
    const int folder = open_folder(it->path());
    struct stat found {};
    if (folder >= 0 && ::fstat(folder, &found) == 0 && found.st_uid == ::geteuid() &&
        std::time(nullptr) - found.st_mtime > kSecondsToLock &&
        ::flock(folder, LOCK_EX | LOCK_NB) == 0) {
      std::error_code ignored;  // another run may be removing it too
      fs::remove_all(it->path(), ignored);
    }
    if (folder >= 0) ::close(folder);
  }
}

}  // namespace

ScratchFolder::ScratchFolder() {
  const char* given = std::getenv("TMPDIR");
  const fs::path above = fs::absolute(given != nullptr && *given != '\0' ? given : "/tmp");
  remove_abandoned(above);
  std::string name = (above / (kPrefix + std::string(kRandom, 'X'))).string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw Error(ExitCode::run_time,
                "TMPDIR: found '{}' ({}); allowed: a folder that can be written", above.string(),
                std::generic_category().message(errno));
  }
  path_ = name;
  lock_ = open_folder(path_);
  if (lock_ >= 0)
    ::flock(lock_, LOCK_EX | LOCK_NB);  // without locks, nobody removes folders of others
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace clpv
