// SPDX-License-Identifier: MIT
#include "cli/drawing.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

#include "support/error.hpp"
#include "support/output_file.hpp"
#include "support/process.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

/// Folder of the Python package clpv: under the prefix of the installed program, or in the source tree.
fs::path package_folder() {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  for (const char* folder : {CLPV_PYTHON_FOLDERS}) {
    const fs::path installed = program.parent_path().parent_path() / folder;
    if (fs::exists(installed / "clpv/draw", failed)) return installed;
  }
  return CLPV_PYTHON_SOURCE;
}

}  // namespace

Drawing::Drawing(std::string kind, std::string asked_by)
    : kind_(std::move(kind)), asked_by_(std::move(asked_by)) {
  run({});
  std::string name = (fs::temp_directory_path() / "clpv-draw-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw Error(ExitCode::run_time, "{}: cannot make {}: {}", asked_by_, name, std::strerror(errno));
  folder_ = name;
}

Drawing::~Drawing() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

void Drawing::add(const std::string& file, const nlohmann::json& document) const {
  write_file(folder_ / file, document.dump());
}

void Drawing::draw(const fs::path& output) const {
  run({folder_.string(), output.string()});
}

/// `python3 -m clpv.draw KIND arguments...`. -B: no bytecode is written to the package.
void Drawing::run(const std::vector<std::string>& arguments) const {
  const char* path = std::getenv("PYTHONPATH");
  std::vector<std::string> words{
      "PYTHONPATH=" + package_folder().string() + (path ? ":" : "") + (path ? path : ""),
      "python3",
      "-B",
      "-m",
      "clpv.draw",
      kind_};
  words.insert(words.end(), arguments.begin(), arguments.end());
  Process::Result ended = Process("/usr/bin/env", words).end();
  if (ended.code == 0) return;
  while (ended.output.ends_with('\n')) ended.output.pop_back();
  if (ended.code == static_cast<int>(ExitCode::bad_input))
    throw Error(ExitCode::bad_input, "{}: {}", asked_by_, ended.output);
  throw Error(ExitCode::run_time, "{}: python3 -m clpv.draw ended with {}: {}", asked_by_, ended.code,
              ended.output);
}

}  // namespace clpv
