// SPDX-License-Identifier: MIT
#include "support/process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

extern char** environ;

namespace clpv {
namespace {

std::vector<char*> words_of(std::string& program, std::vector<std::string>& arguments) {
  std::vector<char*> words{program.data()};
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  return words;
}

std::string contents(std::FILE* file) {
  std::string text;
  std::rewind(file);
  char part[4096];
  for (std::size_t read; (read = std::fread(part, 1, sizeof part, file)) > 0;) text.append(part, read);
  return text;
}

}  // namespace

Process::Process(const std::string& program, const std::vector<std::string>& arguments, bool fed)
    : said_(std::tmpfile()) {
  // A pair of sockets and no pipe: writing to a reader that is gone is then an error and not a signal.
  int ends[2] = {-1, -1};
  if (said_ == nullptr || (fed && ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0)) {
    failed_ = errno;
    return;
  }
  input_ = ends[0];
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (fed) {
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
  } else {
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  }
  posix_spawn_file_actions_adddup2(&actions, ::fileno(said_.get()), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(said_.get()), STDERR_FILENO);
  std::string name = program;
  std::vector<std::string> given = arguments;
  failed_ =
      ::posix_spawnp(&child_, program.c_str(), &actions, nullptr, words_of(name, given).data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (fed) ::close(ends[1]);
  if (failed_ != 0) child_ = -1;
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

Process::Ended Process::end() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
  if (child_ < 0) return {-1, std::strerror(failed_)};
  int status = 0;
  while (::waitpid(child_, &status, 0) < 0 && errno == EINTR) {
  }
  child_ = -1;
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), contents(said_.get())};
}

}  // namespace clpv
