// SPDX-License-Identifier: MIT
#include "support/output_file.hpp"

#include <fcntl.h>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <system_error>
#include <utility>

#include "support/error.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxLinks = 40;  // symbolic links in a row, as Linux allows
constexpr int kMaxNames = 1000;
constexpr mode_t kPermissions = 0777;

std::string reason(int code) {
  return std::generic_category().message(code);
}

[[noreturn]] void reject_output(const fs::path& path, const std::string& why) {
  throw Error(ExitCode::run_time, "{}: cannot be written: {}", path.string(), why);
}

/// Name of a temporary file: hidden, unique in this process, and at most as long as a name may be.
std::string temporary_name(const std::string& target) {
  static std::atomic<unsigned> count{0};
  const std::string suffix = fmt::format(".{}-{}.part", ::getpid(), count++);
  return fmt::format(".{}{}", target.substr(0, NAME_MAX - 1 - suffix.size()), suffix);
}

/// Returns `path` with its symbolic links resolved, those to files that do not exist yet too.
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

/// Returns follow_links(). Throws Error(run_time) if no file can be written there.
fs::path resolve(const fs::path& path) {
  if (path.filename().empty()) reject_output(path, "the path names no file");
  std::error_code error;
  const fs::path target = follow_links(path, error);
  if (error) reject_output(path, error.message());
  if (!fs::is_directory(target.parent_path(), error)) {
    reject_output(path, fmt::format("there is no folder {}", target.parent_path().string()));
  }
  const fs::file_status status = fs::status(target, error);
  if (status.type() == fs::file_type::none)
    reject_output(path, error.message());  // for example a name too long
  if (fs::is_directory(status)) reject_output(path, "it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status))
    reject_output(path, "it is not a regular file");
  if (fs::exists(status) && ::access(target.c_str(), W_OK) != 0) reject_output(path, reason(errno));
  return target;
}

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code missing;
  return follow_links(a, missing) == follow_links(b, missing) || fs::equivalent(a, b, missing);
}

}  // namespace

OutputFile::OutputFile(const fs::path& path, Links links)
    : target_(links == Links::follow ? resolve(path) : path) {
  struct stat replaced {};
  const bool replaces = ::lstat(target_.c_str(), &replaced) == 0 && S_ISREG(replaced.st_mode);
  // The name may exist: of a killed process, or of a process on another machine.
  for (int tries = 0; descriptor_ < 0 && tries < kMaxNames && (tries == 0 || errno == EEXIST);
       ++tries) {
    temporary_ = target_.parent_path() / temporary_name(target_.filename().string());
    descriptor_ =
        ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, replaces ? 0600 : 0666);
  }
  if (descriptor_ < 0) reject_output(target_, reason(errno));
  // Some file systems have no modes.
  if (replaces) static_cast<void>(::fchmod(descriptor_, replaced.st_mode & kPermissions));
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (!renamed_ && !temporary_.empty()) ::unlink(temporary_.c_str());
}

void OutputFile::write(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) reject_output(target_, reason(errno));
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void OutputFile::commit() {
  const int closed = ::close(std::exchange(descriptor_, -1));
  if (closed != 0) reject_output(target_, reason(errno));
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) reject_output(target_, reason(errno));
  renamed_ = true;
}

void check_writable(const fs::path& path) {
  OutputFile probe(path);
}

void check_outputs(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
  std::vector<NamedFile> others = inputs;
  for (const NamedFile& output : outputs) {
    if (output.path.empty()) continue;
    const auto same = std::ranges::find_if(others, [&](const NamedFile& other) {
      return !other.path.empty() && same_file(output.path, other.path);
    });
    if (same != others.end()) {
      throw Error(ExitCode::usage, "{} {}: found the file of {} {}; allowed: another file",
                  output.option, output.path.string(), same->option, same->path.string());
    }
    check_writable(output.path);
    others.push_back(output);
  }
}

void write_file(const fs::path& path, std::span<const std::byte> bytes) {
  OutputFile file(path);
  file.write(bytes);
  file.commit();
}

void write_file(const fs::path& path, std::string_view text) {
  write_file(path, std::as_bytes(std::span(text)));
}

}  // namespace clpv
