#include "bench/plot.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
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

namespace clpv::bench {
namespace {

namespace fs = std::filesystem;

/// Installed beside the program, or where it was built.
fs::path script() {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  const fs::path installed = program.parent_path().parent_path() / "share/clpv/plot.py";
  for (const fs::path& candidate : {installed, fs::path(CLPV_PLOT_SCRIPT)}) {
    if (fs::exists(candidate, failed)) return candidate;
  }
  throw Error(ExitCode::run_time, "--plot: plot.py is neither at {} nor at {}", installed.string(),
              CLPV_PLOT_SCRIPT);
}

/// A temporary file that is gone with the object.
class Scratch {
 public:
  Scratch() : name_((fs::temp_directory_path() / "clpv-plot-XXXXXX").string()) {
    handle_ = mkstemp(name_.data());
    if (handle_ < 0)
      throw Error(ExitCode::run_time, "--plot: cannot make {}: {}", name_, std::strerror(errno));
  }
  ~Scratch() {
    close(handle_);
    std::error_code ignored;
    fs::remove(name_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::string& name() const { return name_; }

 private:
  std::string name_;
  int handle_;
};

/// Every python3 in the path: the first need not be the one that has matplotlib.
std::vector<std::string> pythons() {
  const char* path = std::getenv("PATH");
  std::vector<std::string> found;
  std::istringstream folders(path != nullptr ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string candidate = folder + "/python3";
    if (access(candidate.c_str(), X_OK) == 0) found.push_back(candidate);
  }
  return found;
}

/// Runs `python arguments...`, its output into `said`.
int run_python(const std::string& python, std::vector<std::string> arguments, std::string& said) {
  const Scratch output;
  arguments.insert(arguments.begin(), python);
  std::vector<char*> raw;
  for (std::string& argument : arguments) raw.push_back(argument.data());
  raw.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.name().c_str(), O_WRONLY | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int failed = posix_spawn(&child, python.c_str(), &actions, nullptr, raw.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) return -1;
  int status = 0;
  waitpid(child, &status, 0);
  std::ifstream in(output.name(), std::ios::binary);
  said.assign(std::istreambuf_iterator<char>(in), {});
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// The first python3 with matplotlib.
std::string drawing_python() {
  const std::vector<std::string> all = pythons();
  if (all.empty()) throw Error(ExitCode::run_time, "--plot needs python3, which is not in the path");
  std::string said;
  for (const std::string& python : all) {
    if (run_python(python, {"-c", "import matplotlib"}, said) == 0) return python;
  }
  throw Error(ExitCode::run_time,
              "--plot needs matplotlib (Debian's python3-matplotlib), which {} does not find", all.front());
}

}  // namespace

void require_plots(const fs::path& folder) {
  script();
  drawing_python();
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) throw Error(ExitCode::run_time, "--plot {}: {}", folder.string(), failed.message());
  check_writable(folder / "roofline.svg");
}

void plot(const nlohmann::json& report, const fs::path& folder) {
  const Scratch input;
  std::ofstream(input.name()) << report.dump();
  std::string said;
  const int code = run_python(drawing_python(), {script().string(), input.name(), folder.string()}, said);
  if (code != 0)
    throw Error(ExitCode::run_time, "--plot: {} ended with {}: {}", script().string(), code, said);
}

}  // namespace clpv::bench
