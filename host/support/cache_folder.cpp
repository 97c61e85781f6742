// SPDX-License-Identifier: MIT
#include "support/cache_folder.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <vector>

#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

bool trusted_owner(const struct stat& file) {
  return file.st_uid == ::geteuid() || file.st_uid == 0;
}

/// Returns why nothing is read from this folder or written to it, else "".
std::string distrust(const fs::path& folder) {
  struct stat found {};
  if (::stat(folder.c_str(), &found) != 0) return std::generic_category().message(errno);
  if (!S_ISDIR(found.st_mode)) return "it is not a folder";
  if (!trusted_owner(found)) return "it belongs to another user";
  if ((found.st_mode & (S_IWGRP | S_IWOTH)) != 0)
    return fmt::format("others can write it (mode {:o}); allowed: only its owner can (chmod go-w)",
                       found.st_mode & 07777);
  return {};
}

/// Creates a folder and those above it, for their owner only. Returns 0, or the first failure.
int make_private_folders(const fs::path& folder) {
  if (folder.empty() || ::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST) return 0;
  const int failed = errno == ENOENT ? make_private_folders(folder.parent_path()) : errno;
  return failed != 0 || ::mkdir(folder.c_str(), 0700) == 0 || errno == EEXIST ? failed : errno;
}

/// A file descriptor, closed by the destructor.
struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

}  // namespace

std::optional<std::string> CacheFolder::read(const std::string& name, std::uintmax_t limit) const {
  if (!distrust(path_).empty()) return std::nullopt;
  // O_NONBLOCK: opening a FIFO would wait for its writer.
  const Descriptor file{
      ::open((path_ / name).c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC)};
  struct stat found {};
  if (file.number < 0 || ::fstat(file.number, &found) != 0 || !S_ISREG(found.st_mode) ||
      !trusted_owner(found) || static_cast<std::uintmax_t>(found.st_size) > limit)
    return std::nullopt;
  std::string bytes(static_cast<std::size_t>(found.st_size), '\0');
  for (std::size_t at = 0; at < bytes.size();) {
    const ssize_t count = ::read(file.number, &bytes[at], bytes.size() - at);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return std::nullopt;
    at += static_cast<std::size_t>(count);
  }
  return bytes;
}

/// Creates an entry's temporary file and calls use(file). Returns the reason of a failure, else "".
template <typename Use>
std::string CacheFolder::with_file(const std::string& name, const Use& use) const {
  const int failed = make_private_folders(path_);
  const std::string why = failed == 0 ? distrust(path_) : std::generic_category().message(failed);
  if (!why.empty()) return fmt::format("{}: not used as a cache: {}", path_.string(), why);
  try {
    OutputFile file(path_ / name, OutputFile::Kind::entry);
    use(file);
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

std::string CacheFolder::write(const std::string& name, std::span<const std::byte> bytes) const {
  return with_file(name, [&](OutputFile& file) {
    file.write(bytes);
    file.commit();
  });
}

std::string CacheFolder::write_checked(const std::string& name, std::string bytes) const {
  const std::string sum = Fingerprint().add(bytes).hex();
  return write(name, bytes + sum);
}

std::optional<std::string> CacheFolder::read_checked(const std::string& name) const {
  std::optional<std::string> bytes = read(name);
  const std::size_t digits = Fingerprint().hex().size();
  if (!bytes || bytes->size() < digits) return std::nullopt;
  const std::string sum = bytes->substr(bytes->size() - digits);
  bytes->resize(bytes->size() - digits);
  if (Fingerprint().add(*bytes).hex() == sum) return bytes;
  log_debug("{}: damaged, or of another version; not used", (path_ / name).string());
  return std::nullopt;
}

void CacheFolder::evict(const std::regex& own, std::uint64_t bytes,
                        fs::file_time_type::duration age) const {
  struct File {
    fs::file_time_type used;
    std::uint64_t bytes;
    fs::path path;
  };
  std::vector<File> files;
  std::uint64_t total = 0;
  // Other processes may evict files meanwhile: missing files are not counted.
  std::error_code error;
  for (fs::directory_iterator it(path_, error), end; !error && it != end; it.increment(error)) {
    std::error_code gone;
    File file{it->last_write_time(gone), 0, it->path()};
    if (!gone) file.bytes = it->file_size(gone);
    if (gone || !std::regex_match(file.path.filename().string(), own)) continue;
    total += file.bytes;
    files.push_back(std::move(file));
  }
  std::ranges::sort(files, {}, &File::used);
  const auto now = fs::file_time_type::clock::now();
  for (const File& file : files) {
    if (total <= bytes && now - file.used <= age) break;
    if (fs::remove(file.path, error)) total -= file.bytes;
  }
}

std::string CacheFolder::problem() const {
  return with_file("probe", [](OutputFile&) {});
}

ScratchFolder::ScratchFolder() {
  const char* given = std::getenv("TMPDIR");
  const fs::path above = fs::absolute(given != nullptr && *given != '\0' ? given : "/tmp");
  std::string name = (above / ".clpv-run-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw Error(ExitCode::run_time,
                "TMPDIR: found '{}' ({}); allowed: a folder that can be written", above.string(),
                std::generic_category().message(errno));
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace clpv
