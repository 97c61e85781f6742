// SPDX-License-Identifier: MIT
#include "support/process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <thread>
#include <utility>

#include "support/interrupt.hpp"

extern char** environ;

namespace clpv {
namespace {

constexpr std::chrono::milliseconds kPollOfEnd{5};

std::vector<char*> argument_pointers(std::string& program, std::vector<std::string>& arguments) {
  std::vector<char*> words{program.data()};
  for (std::string& argument : arguments) words.push_back(argument.data());
  words.push_back(nullptr);
  return words;
}

/// A file descriptor above those of stdin, stdout and stderr, which a child replaces.
int above_streams(int descriptor) {
  if (descriptor < 0 || descriptor > STDERR_FILENO) return descriptor;
  const int moved = ::fcntl(descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
  ::close(descriptor);
  return moved;
}

std::FILE* file_in_memory() {
  const int descriptor = above_streams(::memfd_create("output", MFD_CLOEXEC));
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

/// Files of a child's stdin, stdout and stderr.
using Streams = std::array<int, 3>;

/// In the child of vfork(), which shares this process's memory until it runs the program: only
/// system calls. Returns errno of the failure.
int become(const char* program, char* const* words, const Streams& streams, pid_t parent) {
  if (::prctl(PR_SET_PDEATHSIG, SIGKILL) != 0) return errno;
  if (::getppid() != parent) return ESRCH;  // it ended before prctl()
  if (::setpgid(0, 0) != 0) return errno;   // kill() ends what it starts, too
  for (int stream = 0; stream < 3; ++stream)
    if (::dup2(streams[stream], stream) < 0) return errno;
  for (int signal = 1; signal < NSIG; ++signal) {  // no handler of this process may run
    const bool stays = signal != SIGCHLD && signal != SIGPIPE && signal != SIGXFSZ;
    if (std::signal(signal, SIG_DFL) == SIG_IGN && stays) std::signal(signal, SIG_IGN);
  }
  sigset_t none;
  sigemptyset(&none);
  if (::sigprocmask(SIG_SETMASK, &none, nullptr) != 0) return errno;
  ::execve(program, words, environ);
  return errno;
}

/// Starts a program that the kernel ends with this thread, however that ends. posix_spawn() has no
/// such attribute. Returns its process; -1, and errno in `failure`, if it does not start.
pid_t start(const char* program, char* const* words, const Streams& streams, int& failure) {
  sigset_t all, before;
  sigfillset(&all);  // the child must not run this process's handlers
  ::pthread_sigmask(SIG_SETMASK, &all, &before);
  const pid_t parent = ::getpid();
  volatile int reason = 0;
  const pid_t child = ::vfork();
  if (child == 0) {
    reason = become(program, words, streams, parent);
    ::_exit(127);
  }
  failure = child < 0 ? errno : reason;
  if (child > 0 && reason != 0) ::waitpid(child, nullptr, 0);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return failure == 0 ? child : -1;
}

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

void reset_inherited_state() {
  // A missing stdout or stderr would become the first file that opens, and get what is printed.
  // Opened the other way round, they fail as closed ones do.
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    const int mode = stream == STDIN_FILENO ? O_WRONLY : O_RDONLY;
    if (::fcntl(stream, F_GETFD) < 0) static_cast<void>(::open("/dev/null", mode));
  }
  std::signal(SIGCHLD, SIG_DFL);
  sigset_t none;
  sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

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
  const int stdin_file =
      above_streams(with_input ? ends[1] : ::open("/dev/null", O_RDONLY | O_CLOEXEC));
  const int stdout_file = ::fileno(output_.get());
  std::string name = program.string();
  std::vector<std::string> words = arguments;
  child_ = start(program.c_str(), argument_pointers(name, words).data(),
                 {stdin_file, stdout_file, stdout_file}, start_error_);
  if (stdin_file >= 0) ::close(stdin_file);
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

/// Returns false once the process has ended, or its status is lost: the kernel reaps children of a
/// process that ignores SIGCHLD, and another thread may wait for all children.
bool Process::running() {
  if (child_ < 0 || exited_) return false;
  pid_t waited = -1;
  do {
    waited = ::waitpid(child_, &status_, WNOHANG);
  } while (waited < 0 && errno == EINTR);
  if (waited < 0) lost_ = errno;
  exited_ = waited != 0;
  return !exited_;
}

void Process::kill() {
  if (running()) ::kill(-child_, SIGKILL);
}

Process::Result Process::end() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
  if (child_ < 0) return {-1, std::strerror(start_error_)};
  for (; running(); std::this_thread::sleep_for(kPollOfEnd))
    if (interrupted()) kill();
  child_ = -1;
  if (lost_ != 0) {
    return {-1, fmt::format("its exit status is lost ({}): this process ignores SIGCHLD, or "
                            "something else in it waits for all children\n{}",
                            std::strerror(lost_), contents(output_.get()))};
  }
  return {WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_),
          contents(output_.get())};
}

}  // namespace clpv
