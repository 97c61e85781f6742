// SPDX-License-Identifier: MIT
#include "support/output_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <system_error>

#include "support/error.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxLinks = 40;  // symbolic links in a row, as Linux allows
constexpr int kMaxNames = 1000;

std::string reason(int code) {
  return std::generic_category().message(code);
}

[[noreturn]] void reject_output(const fs::path& path, const std::string& why) {
  throw Error(ExitCode::run_time, "{}: cannot be written: {}", path.string(), why);
}

/// Temporary file in the folder of its target; the destructor removes it unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : target_(target) {
    static std::atomic<unsigned> count{0};
    // The name may exist: of a killed process, or of a process on another machine.
    for (int tries = 0; descriptor_ < 0 && tries < kMaxNames && (tries == 0 || errno == EEXIST); ++tries) {
      path_ = target.parent_path() /
              fmt::format(".{}.{}-{}.part", target.filename().string(), ::getpid(), count++);
      descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    }
    if (descriptor_ < 0) reject_output(target_, reason(errno));
  }
  ~TemporaryFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!renamed_) ::unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  void write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) reject_output(target_, reason(errno));
      bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
  }

  void rename_into_place() {
    const int closed = ::close(std::exchange(descriptor_, -1));
    if (closed != 0) reject_output(target_, reason(errno));
    if (::rename(path_.c_str(), target_.c_str()) != 0) reject_output(target_, reason(errno));
    renamed_ = true;
  }

 private:
  fs::path target_, path_;
  int descriptor_ = -1;
  bool renamed_ = false;
};

/// Returns `path` with its symbolic links resolved. Throws Error(run_time) if no file can be written there.
fs::path resolve(const fs::path& path) {
  if (path.filename().empty()) reject_output(path, "the path names no file");
  std::error_code error;
  // Absolute first: weakly_canonical drops the folder of a relative path that does not exist yet.
  fs::path target = fs::weakly_canonical(fs::absolute(path, error), error);
  if (error) reject_output(path, error.message());
  // A remaining link points to a file that does not exist yet.
  for (int hops = 0; fs::is_symlink(fs::symlink_status(target, error)); ++hops) {
    if (hops == kMaxLinks) reject_output(path, fmt::format("more than {} symbolic links", kMaxLinks));
    const fs::path next = fs::read_symlink(target, error);
    if (!error) target = fs::weakly_canonical(target.parent_path() / next, error);
    if (error) reject_output(path, error.message());
  }
  if (!fs::is_directory(target.parent_path(), error)) {
    reject_output(path, fmt::format("there is no folder {}", target.parent_path().string()));
  }
  const fs::file_status status = fs::status(target, error);
  if (fs::is_directory(status)) reject_output(path, "it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) reject_output(path, "it is not a regular file");
  if (fs::exists(status) && ::access(target.c_str(), W_OK) != 0) reject_output(path, reason(errno));
  return target;
}

}  // namespace

void check_writable(const std::filesystem::path& path) {
  TemporaryFile probe(resolve(path));
}

void write_file(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  TemporaryFile file(resolve(path));
  file.write(bytes);
  file.rename_into_place();
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  write_file(path, std::as_bytes(std::span(text)));
}

}  // namespace clpv
