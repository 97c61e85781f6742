// SPDX-License-Identifier: MIT
#include "support/helpers.hpp"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <thread>

#include "support/error.hpp"
#include "support/input_file.hpp"
#include "support/output_file.hpp"
#include "support/text.hpp"

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

const std::string& this_program() {
  return helper_program();
}

void set_helper_program(std::string file) {
  helper_program() = std::move(file);
}

bool has_helper_program() {
  return !helper_program().empty();
}

unsigned helper_count() {
  cpu_set_t bound;  // to these cores; hardware_concurrency() counts all
  const unsigned cores = ::sched_getaffinity(0, sizeof bound, &bound) == 0 ? CPU_COUNT(&bound) : 1;
  return !has_helper_program() || cores < 2 ? 0 : std::min(cores, kMaxHelpers);
}

bool Claims::take(const std::string& name) const {
  const fs::path file = folder_ / name;
  const int opened = ::open(file.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0600);
  if (opened < 0 && errno == EEXIST) return false;
  if (opened < 0) throw Error(ExitCode::run_time, "{}: {}", file.string(), std::strerror(errno));
  ::dprintf(opened, "%d", ::getpid());
  ::close(opened);
  return true;
}

std::optional<Claims::Taken> Claims::taken(const std::string& name) const {
  const fs::path file = folder_ / name;
  const auto owner = parse_number<int>(file_bytes(file.string()).value_or(""));
  if (!owner) return std::nullopt;
  return Taken{*owner, fs::file_time_type::clock::now() - fs::last_write_time(file)};
}

void Claims::finish(const std::string& name, const std::string& result) const {
  write_file(folder_ / (name + kDone), result, OutputFile::Kind::entry);
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

Helpers::Helpers(std::vector<std::string> arguments, unsigned count)
    : claims_(folder_.path()), arguments_(std::move(arguments)) {
  arguments_.insert(arguments_.end(), {"--claims", folder_.path().string()});
  for (unsigned i = 0; i < count; ++i) start();
}

Helpers::~Helpers() {
  for (const auto& child : children_) child->kill();
  children_.clear();
}

void Helpers::start() {
  children_.push_back(std::make_unique<Process>(helper_program(), arguments_));
}

bool Helpers::wait() {
  std::this_thread::sleep_for(kPoll);
  std::erase_if(children_, [&](const auto& child) {
    const pid_t process = child->id();
    if (child->running()) return false;
    Process::Result result = child->end();
    ended_.push_back({process, result.code, std::move(result.output)});
    return true;
  });
  return !children_.empty();
}

void Helpers::kill(pid_t process) {
  for (const auto& child : children_)
    if (child->id() == process) child->kill();
}

std::string Helpers::failures() const {
  std::string text;
  for (const Ended& ended : ended_)
    if (ended.code != 0) text += ended.output;
  return text;
}

void become_helper() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
}

}  // namespace clpv
