// SPDX-License-Identifier: MIT
#include "commands/drawing.hpp"

#include <fmt/ranges.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "support/error.hpp"
#include "support/output_file.hpp"
#include "support/process.hpp"

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

/// `python -B package arguments...`. -B: nothing is written beside the package.
Process::Ended run(const fs::path& python, const fs::path& package,
                   const std::vector<std::string>& arguments) {
  std::vector<std::string> words{"-B", package.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return Process(python, words).end();
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
  for (const fs::path& python :
       find_programs("python3")) {  // the first need not be the one that has the modules
    const Process::Ended ended = run(python, package_, {"check", name_of(picture_)});
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
  const Process::Ended ended = run(python_, package_, {name_of(picture_), folder_.string(), output.string()});
  if (ended.code == 0) return;
  if (ended.code == static_cast<int>(ExitCode::bad_input))
    throw Error(ExitCode::bad_input, "{}: {}", asked_by_, in_a_line(ended.said));
  throw Error(ExitCode::run_time, "{}: {} ended with {}: {}", asked_by_, package_.string(), ended.code,
              ended.said);
}

}  // namespace clpv
