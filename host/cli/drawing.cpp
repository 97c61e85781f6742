// SPDX-License-Identifier: MIT
#include "cli/drawing.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>

#include "image/image_io.hpp"
#include "support/array_files.hpp"
#include "support/cache_folder.hpp"
#include "support/error.hpp"
#include "support/input_file.hpp"
#include "support/interrupt.hpp"
#include "support/log.hpp"
#include "support/output_file.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

// Python isolated from the current folder, the user's packages and PYTHON... variables (-I),
// without writing bytecode (-B). The package's folder comes first only while the package is
// imported. matplotlib reads settings from the current folder, hence '/'.
constexpr const char* kMain = R"(
import os, sys
sys.path.insert(0, sys.argv.pop(1))
import clpv.draw
del sys.path[0]
os.chdir('/')
from clpv.draw.__main__ import main
sys.exit(main(sys.argv[1:]))
)";

/// Folder of the Python package clpv: under the prefix of the installed program, or in the source
/// tree.
fs::path package_folder() {
  std::error_code failed;
  const fs::path program = fs::read_symlink("/proc/self/exe", failed);
  for (const char* folder : {CLPV_PYTHON_FOLDERS}) {
    const fs::path installed = program.parent_path().parent_path() / folder;
    if (fs::exists(installed / "clpv/draw", failed)) return installed;
  }
  return CLPV_PYTHON_SOURCE;
}

/// Interpreters to try, best first.
std::vector<fs::path> interpreters() {
  if (const char* given = std::getenv("CLPV_PYTHON"); given != nullptr && *given != '\0') {
    const fs::path file = given;
    return {file.has_parent_path() ? file : find_program(given).value_or(file)};
  }
  std::vector<fs::path> all;
  std::error_code unknown;
  for (const fs::path& file :
       {fs::path(CLPV_PYTHON_INSTALLED), find_program("python3").value_or(""),
        fs::path("/usr/bin/python3")}) {
    if (fs::exists(file, unknown) && std::ranges::count(all, file) == 0) all.push_back(file);
  }
  return all;
}

/// Keeps matplotlib's list of fonts in clpv's cache, and its empty folder of settings out of HOME.
/// Without a cache they are in the scratch folder.
void choose_matplotlib_folder(const fs::path& scratch) {
  fs::path folder = scratch / "matplotlib";
  if (const auto cache = user_cache_folder();
      cache && CacheFolder(*cache / "matplotlib").problem().empty())
    folder = *cache / "matplotlib";
  ::setenv("MPLCONFIGDIR", folder.c_str(), 1);
}

std::string first_line(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

}  // namespace

Drawing::Drawing(std::string kind, std::string asked_by)
    : kind_(std::move(kind)), asked_by_(std::move(asked_by)) {
  choose_matplotlib_folder(scratch_.path());
  std::string tried;
  for (const fs::path& python : interpreters()) {
    const Process::Result ended = run(python, {});
    stop_if_interrupted();
    if (ended.code == 0) {
      python_ = python;
      log_debug("{}: drawing with {}", asked_by_, python_.string());
      return;
    }
    tried += fmt::format("\n  {}: {}", python.string(), first_line(ended.output));
  }
  throw Error(ExitCode::run_time,
              "{}: no Python can draw; CLPV_PYTHON names one with matplotlib, NumPy and Jinja2 "
              "(Debian: python3-matplotlib python3-numpy python3-jinja2; pip: clpv[draw]). "
              "Tried:{}",
              asked_by_, tried.empty() ? " none: there is no python3" : tried);
}

void Drawing::add(const std::string& file, const nlohmann::json& document) const {
  write_file(scratch_.path() / file, document.dump(), OutputFile::Kind::entry);
}

void Drawing::add(const std::string& file, std::span<const float> values, int width,
                  int height) const {
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  write_npy(scratch_.path() / file, values,
            std::array{rows, columns, values.size() / (rows * columns)});
}

void Drawing::draw(const fs::path& output) const {
  const fs::path drawn = scratch_.path() / "drawn";
  const Process::Result ended = run(python_, {scratch_.path().string(), drawn.string()});
  stop_if_interrupted(fmt::format("{} was not written", output.string()));
  const auto bytes = file_bytes(drawn, std::numeric_limits<std::uintmax_t>::max());
  if (ended.code == 0 && bytes)
    return write_file(output, *bytes,
                      kind_ == "report" ? OutputFile::Kind::derived : OutputFile::Kind::result);
  if (ended.code == static_cast<int>(ExitCode::bad_input))
    throw Error(ExitCode::bad_input, "{}: {}", asked_by_, ended.output);
  throw Error(ExitCode::run_time, "{}: {} -m clpv.draw ended with {}: {}", asked_by_,
              python_.string(), ended.code, ended.output);
}

Process::Result Drawing::run(const fs::path& python,
                             const std::vector<std::string>& arguments) const {
  std::vector<std::string> words{"-I", "-B", "-c", kMain, package_folder().string(), kind_};
  words.insert(words.end(), arguments.begin(), arguments.end());
  Process::Result ended = Process(python, words).end();
  while (ended.output.ends_with('\n')) ended.output.pop_back();
  return ended;
}

Image read_image_layer(const std::filesystem::path& file, const std::string& layer) {
  Image image = extract_layer(read_image(file), layer, file.string());
  for (const std::string& note : image.notes) log_warning("{}: {}", file.string(), note);
  return image;
}

}  // namespace clpv
