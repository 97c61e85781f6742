// SPDX-License-Identifier: MIT
#include "commands/drawing.hpp"

#include <fcntl.h>
#include <fmt/ranges.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "support/error.hpp"
#include "support/output_file.hpp"

extern char** environ;

namespace clpv {
namespace {

namespace fs = std::filesystem;

const char* name_of(Picture picture) {
  switch (picture) {
    case Picture::bench:
      return "bench";
    case Picture::basis:
      return "basis";
    case Picture::report:
      return "report";
  }
  return "";
}

/// Installed beside the program, or where it was built.
fs::path find_package(const std::string& asked_by) {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  const fs::path installed = program.parent_path().parent_path() / "share/clpv/clpv_draw";
  for (const fs::path& candidate : {installed, fs::path(CLPV_DRAW_PACKAGE)}) {
    if (fs::exists(candidate / "__main__.py", failed)) return candidate;
  }
  throw Error(ExitCode::run_time, "{}: the Python package clpv_draw is neither at {} nor at {}", asked_by,
              installed.string(), CLPV_DRAW_PACKAGE);
}

/// Every python3 in the path: the first need not be the one that has the modules.
std::vector<fs::path> pythons() {
  const char* path = std::getenv("PATH");
  std::vector<fs::path> found;
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path candidate = fs::path(folder) / "python3";
    if (access(candidate.c_str(), X_OK) == 0) found.push_back(candidate);
  }
  return found;
}

struct Ended {
  int code = -1;     ///< 128 + signal where one ended it; -1: could not be started
  std::string said;  ///< on stdout and stderr
};

/// `python -B package arguments...`, what it says into a file in `folder`. -B: nothing is written beside the package.
Ended run(const fs::path& python, const fs::path& package, const std::vector<std::string>& arguments,
          const fs::path& folder) {
  const fs::path output = folder / "said.txt";
  std::vector<std::string> words{python.string(), "-B", package.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> raw;
  for (std::string& word : words) raw.push_back(word.data());
  raw.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int failed = posix_spawn(&child, python.c_str(), &actions, nullptr, raw.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return {-1, std::strerror(failed)};
  int status = 0;
  waitpid(child, &status, 0);
  std::ifstream in(output, std::ios::binary);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status),
          {std::istreambuf_iterator<char>(in), {}}};
}

/// All of it in one line.
std::string in_a_line(const std::string& said) {
  std::istringstream in(said);
  const std::vector<std::string> words{std::istream_iterator<std::string>(in), {}};
  return fmt::format("{}", fmt::join(words, " "));
}

}  // namespace

Drawing::Drawing(Picture picture, std::string asked_by)
    : picture_(picture), asked_by_(std::move(asked_by)), package_(find_package(asked_by_)) {
  std::string name = (fs::temp_directory_path() / "clpv-draw-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw Error(ExitCode::run_time, "{}: cannot make {}: {}", asked_by_, name, std::strerror(errno));
  folder_ = name;
  std::vector<std::string> lacking;
  for (const fs::path& python : pythons()) {
    const Ended ended = run(python, package_, {"check", name_of(picture_)}, folder_);
    if (ended.code == 0) {
      python_ = python;
      return;
    }
    lacking.push_back(fmt::format("{} lacks {}", python.string(), in_a_line(ended.said)));
  }
  fs::remove_all(folder_);
  if (lacking.empty())
    throw Error(ExitCode::run_time, "{} needs python3, which is not in the path (Debian: python3)",
                asked_by_);
  throw Error(ExitCode::run_time, "{} needs modules of Python, named by Debian's packages: {}", asked_by_,
              fmt::join(lacking, "; "));
}

Drawing::~Drawing() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void Drawing::add(const std::string& file, const nlohmann::json& document) const {
  write_file(folder_ / file, document.dump());
}

void Drawing::draw(const fs::path& output) const {
  const Ended ended = run(python_, package_, {name_of(picture_), folder_.string(), output.string()}, folder_);
  if (ended.code == 0) return;
  if (ended.code == static_cast<int>(ExitCode::bad_input))
    throw Error(ExitCode::bad_input, "{}: {}", asked_by_, in_a_line(ended.said));
  throw Error(ExitCode::run_time, "{}: {} ended with {}: {}", asked_by_, package_.string(), ended.code,
              ended.said);
}

}  // namespace clpv
