// SPDX-License-Identifier: MIT
#include "support/helpers.hpp"

#include <fcntl.h>
#include <sched.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <thread>

#include "support/error.hpp"
#include "support/input_file.hpp"
#include "support/output_file.hpp"
#include "support/process.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kMaxHelpers = 8;  // each needs a few hundred MB
constexpr std::chrono::milliseconds kPoll{30};
constexpr const char* kDone = ".done";

std::string& helper_program() {
  static std::string file;
  return file;
}

}  // namespace

void set_helper_program(std::string file) {
  helper_program() = std::move(file);
}

unsigned helper_count() {
  cpu_set_t bound;  // to these cores; hardware_concurrency() counts all
  const unsigned cores = ::sched_getaffinity(0, sizeof bound, &bound) == 0 ? CPU_COUNT(&bound) : 1;
  return helper_program().empty() || cores < 2 ? 0 : std::min(cores, kMaxHelpers);
}

bool Claims::take(const std::string& name) const {
  const fs::path file = folder_ / name;
  const int opened = ::open(file.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
  if (opened < 0 && errno == EEXIST) return false;
  if (opened < 0) throw Error(ExitCode::run_time, "{}: {}", file.string(), std::strerror(errno));
  ::close(opened);
  return true;
}

void Claims::finish(const std::string& name, const std::string& result) const {
  write_file(folder_ / (name + kDone), result);
}

bool Claims::finished(const std::string& name) const {
  return fs::exists(folder_ / (name + kDone));
}

std::string Claims::result(const std::string& name) const {
  return file_bytes((folder_ / (name + kDone)).string()).value_or("");
}

std::size_t Claims::finished_count() const {
  return std::ranges::count_if(fs::directory_iterator(folder_),
                               [](const auto& entry) { return entry.path().extension() == kDone; });
}

struct Helpers::Child {
  explicit Child(const std::vector<std::string>& arguments) : process(helper_program(), arguments) {}
  Process process;
  bool ended = false;
};

Helpers::Helpers(std::vector<std::string> arguments) : claims_(folder_.path()) {
  arguments.insert(arguments.end(), {"--claims", folder_.path().string()});
  for (unsigned i = 0; i < helper_count(); ++i) children_.push_back(std::make_unique<Child>(arguments));
}

Helpers::~Helpers() {
  for (const auto& child : children_) child->process.kill();
  children_.clear();
}

bool Helpers::wait() {
  std::this_thread::sleep_for(kPoll);
  bool running = false;
  for (const auto& child : children_) {
    if (child->ended) continue;
    if (child->process.running()) {
      running = true;
      continue;
    }
    child->ended = true;
    const Process::Result result = child->process.end();
    if (result.code != 0) failures_ += result.output;
  }
  return running;
}

void become_helper() {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, SIG_DFL);
}

}  // namespace clpv
