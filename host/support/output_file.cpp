// SPDX-License-Identifier: MIT
#include "support/output_file.hpp"

#include <fcntl.h>
#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <map>
#include <system_error>
#include <utility>

#include "support/error.hpp"
#include "support/interrupt.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

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

/// Returns follow_links(). Throws Error(run_time) if no file can be written there.
fs::path resolve(const fs::path& path, OutputFile::Kind kind) {
  if (path.filename().empty()) reject_output(path, "the path names no file");
  std::error_code error;
  if (kind == OutputFile::Kind::derived && fs::is_symlink(fs::symlink_status(path, error)))
    reject_output(path, "it is a symbolic link; allowed: none, or a regular file");
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

/// Throws Error(usage) if the target is an input.
void spare_input(const fs::path& target) {
  if (const auto input = InputRecord::find(identity_of(target)))
    throw Error(ExitCode::usage, "{}: found the file of {} {}; allowed: another file",
                target.string(), input->option, input->path.string());
}

/// Waits until a file or folder is on the disk and closes it. Returns the error, else 0.
int sync_and_close(int descriptor) {
  const bool fails = ::fsync(descriptor) != 0;
  const bool cannot =
      errno == EINVAL || errno == ENOTSUP || errno == ENOSYS;  // file systems differ
  const int error = fails && !cannot ? errno : 0;
  return ::close(descriptor) != 0 && error == 0 ? errno : error;
}

// Temporary files of unfinished outputs; more than a command writes at once.
std::array<std::atomic<const char*>, 8> unfinished{};
static_assert(std::atomic<const char*>::is_always_lock_free);

void replace_unfinished(const char* from, const char* to) {
  for (auto& slot : unfinished) {
    const char* expected = from;
    if (slot.compare_exchange_strong(expected, to)) return;
  }
}

}  // namespace

void remove_unfinished_outputs() {
  for (const auto& slot : unfinished)
    if (const char* file = slot) ::unlink(file);
}

OutputFile::OutputFile(const fs::path& path, Kind kind)
    : target_(kind == Kind::entry ? path : resolve(path, kind)), kind_(kind) {
  spare_input(target_);
  struct stat replaced {};
  const bool replaces = kind != Kind::entry && ::lstat(target_.c_str(), &replaced) == 0;
  create(replaces ? 0600 : 0666);
  // Some file systems have no modes.
  if (replaces) static_cast<void>(::fchmod(descriptor_, replaced.st_mode & kPermissions));
}

OutputFile::~OutputFile() {
  discard();
}

/// Creates the temporary file.
void OutputFile::create(mode_t mode) {
  // The name may exist: of a killed process, or of a process on another machine.
  for (int tries = 0; descriptor_ < 0 && tries < kMaxNames && (tries == 0 || errno == EEXIST);
       ++tries) {
    temporary_ = target_.parent_path() / temporary_name(target_.filename().string());
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  }
  if (descriptor_ < 0) {
    temporary_.clear();
    reject_output(target_, reason(errno));
  }
  replace_unfinished(nullptr, temporary_.c_str());
}

/// Removes the temporary file, if any.
void OutputFile::discard() {
  if (descriptor_ >= 0) ::close(std::exchange(descriptor_, -1));
  if (temporary_.empty()) return;
  ::unlink(temporary_.c_str());
  replace_unfinished(temporary_.c_str(), nullptr);
  temporary_.clear();
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
  const bool lasts = kind_ != Kind::entry;
  const int file = std::exchange(descriptor_, -1);
  const int error = lasts ? sync_and_close(file) : ::close(file) != 0 ? errno : 0;
  if (error != 0) reject_output(target_, reason(error));
  spare_input(target_);
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) reject_output(target_, reason(errno));
  replace_unfinished(temporary_.c_str(), nullptr);
  temporary_.clear();
  if (!lasts) return;
  // A folder that its user cannot read cannot be opened.
  const int folder = ::open(target_.parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (const int unsafe = folder < 0 ? 0 : sync_and_close(folder); unsafe != 0)
    reject_output(target_, reason(unsafe));
}

void check_writable(const fs::path& path, OutputFile::Kind kind) {
  OutputFile probe(path, kind);
}

void check_outputs(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
  std::map<FileIdentity, NamedFile> others;
  for (const NamedFile& input : inputs)
    if (!input.path.empty()) others.try_emplace(identity_of(input.path), input);
  for (const NamedFile& output : outputs) {
    if (output.path.empty()) continue;
    const FileIdentity file = identity_of(output.path);
    const auto other = others.find(file);
    if (const auto same = other != others.end() ? other->second : InputRecord::find(file)) {
      throw Error(ExitCode::usage, "{} {}: found the file of {} {}; allowed: another file",
                  output.option, output.path.string(), same->option, same->path.string());
    }
    check_writable(output.path,
                   output.derived ? OutputFile::Kind::derived : OutputFile::Kind::result);
    others.emplace(file, output);
  }
}

void write_file(const fs::path& path, std::span<const std::byte> bytes, OutputFile::Kind kind) {
  OutputFile file(path, kind);
  file.write(bytes);
  if (kind != OutputFile::Kind::entry)
    stop_if_interrupted(fmt::format("{} was not written", path.string()));
  file.commit();
}

void write_file(const fs::path& path, std::string_view text, OutputFile::Kind kind) {
  write_file(path, std::as_bytes(std::span(text)), kind);
}

}  // namespace clpv
