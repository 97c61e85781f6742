// SPDX-License-Identifier: MIT
#include "support/scratch_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "support/error.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "clpv-scratch";
constexpr const char* kNewMark = "clpv-scratch.new";  // not locked yet

[[noreturn]] void reject_above(const fs::path& above) {
  throw Error(ExitCode::run_time, "TMPDIR: found '{}' ({}); allowed: a folder that can be written",
              above.string(), std::generic_category().message(errno));
}

/// Returns true for a folder, and no link to one, that only this user can have written.
bool is_own(const fs::path& folder) {
  struct stat found {};
  return ::lstat(folder.c_str(), &found) == 0 && S_ISDIR(found.st_mode) &&
         found.st_uid == ::geteuid() && (found.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

/// Opens a mark and locks it; returns -1 if there is none, or if its process lives.
int lock_mark(const fs::path& mark, int flags) {
  const int opened = ::open(mark.c_str(), flags | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0600);
  if (opened < 0 || ::flock(opened, LOCK_EX | LOCK_NB) == 0) return opened;
  ::close(opened);
  return -1;
}

/// Removes the marked folders in `own` whose process has ended without removing them.
void remove_abandoned(const fs::path& own) {
  std::error_code error;
  for (fs::directory_iterator it(own, error), end; !error && it != end; it.increment(error)) {
    const int lock = is_own(it->path()) ? lock_mark(it->path() / kMark, O_RDONLY) : -1;
    if (lock < 0) continue;
    std::error_code ignored;  // another run may be removing it too
    fs::remove_all(it->path(), ignored);
    ::close(lock);
  }
}

/// Marks a new folder. The mark appears under its name only when it is locked. Without locks,
/// nobody removes folders of others. Returns the open mark.
int mark_as_own(const fs::path& folder) {
  const int lock = lock_mark(folder / kNewMark, O_WRONLY | O_CREAT | O_EXCL);
  if (lock >= 0) ::rename((folder / kNewMark).c_str(), (folder / kMark).c_str());
  return lock;
}

/// Returns the folder that all temporary folders of this user lie in, else `above`.
fs::path folder_of_user(const fs::path& above) {
  const fs::path own = above / fmt::format(".clpv-scratch-{}", ::geteuid());
  if (::mkdir(own.c_str(), 0700) != 0 && errno != EEXIST) reject_above(above);
  if (is_own(own)) return own;
  log_warning("{}: not used, since others can write it; allowed: a folder of this user, mode 700",
              own.string());
  return above;
}

}  // namespace

ScratchFolder::ScratchFolder() {
  const char* given = std::getenv("TMPDIR");
  const fs::path above = fs::absolute(given != nullptr && *given != '\0' ? given : "/tmp"),
                 own = folder_of_user(above);
  const bool shared = own == above;
  if (!shared) remove_abandoned(own);
  std::string name = (own / (shared ? ".clpv-run-XXXXXX" : "run-XXXXXX")).string();
  if (::mkdtemp(name.data()) == nullptr) reject_above(above);
  path_ = name;
  lock_ = mark_as_own(path_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  if (lock_ >= 0) ::close(lock_);
}

}  // namespace clpv
