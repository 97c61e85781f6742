// SPDX-License-Identifier: MIT
#include "support/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

extern char** environ;

namespace clpv {
namespace {

std::vector<char*> argument_pointers(std::string& program, std::vector<std::string>& arguments) {
  std::vector<char*> words{program.data()};
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  return words;
}

std::FILE* file_in_memory() {
  const int descriptor = ::memfd_create("output", MFD_CLOEXEC);
  return descriptor >= 0 ? ::fdopen(descriptor, "w+") : nullptr;
}

std::string contents(std::FILE* file) {
  std::string text;
  std::rewind(file);
  char buffer[4096];
  for (std::size_t read; (read = std::fread(buffer, 1, sizeof buffer, file)) > 0;)
    text.append(buffer, read);
  return text;
}

}  // namespace

namespace {

/// The absolute entries of PATH.
std::vector<std::string> program_folders() {
  const char* path = std::getenv("PATH");
  std::istringstream entries(path != nullptr ? path : "/usr/bin:/bin");
  std::vector<std::string> folders;
  for (std::string entry; std::getline(entries, entry, ':');)
    if (entry.starts_with('/')) folders.push_back(entry);
  return folders;
}

}  // namespace

void keep_absolute_path_entries() {
  ::setenv("PATH", fmt::format("{}", fmt::join(program_folders(), ":")).c_str(), 1);
}

std::optional<std::filesystem::path> find_program(const std::string& name) {
  for (const std::string& folder : program_folders()) {
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    std::error_code unknown;
    if (std::filesystem::is_regular_file(file, unknown) && ::access(file.c_str(), X_OK) == 0)
      return file;
  }
  return std::nullopt;
}

Process::Process(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                 bool with_input)
    : output_(file_in_memory()) {
  // Sockets instead of a pipe: writing to a closed reader is then an error, not SIGPIPE.
  int ends[2] = {-1, -1};
  if (output_ == nullptr ||
      (with_input && ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)) {
    start_error_ = errno;
    return;
  }
  input_ = ends[0];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (with_input) {
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  } else {
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  posix_spawn_file_actions_adddup2(&actions, ::fileno(output_.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(output_.get()), STDERR_FILENO);
  std::string name = program.string();
  std::vector<std::string> words = arguments;
  start_error_ = ::posix_spawn(&child_, program.c_str(), &actions, nullptr,
                               argument_pointers(name, words).data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (with_input) ::close(ends[1]);
  if (start_error_ != 0) child_ = -1;
}

Process::~Process() {
  end();
}

bool Process::feed(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent < 0 && errno == EINTR) continue;
    if (sent < 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(sent));
  }
  return true;
}

bool Process::running() {
  if (child_ < 0 || exited_) return false;
  exited_ = ::waitpid(child_, &status_, WNOHANG) == child_;
  return !exited_;
}

void Process::kill() {
  if (running()) ::kill(child_, SIGKILL);
}

Process::Result Process::end() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
  if (child_ < 0) return {-1, std::strerror(start_error_)};
  while (!exited_ && ::waitpid(child_, &status_, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  return {WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_),
          contents(output_.get())};
}

}  // namespace clpv
