// SPDX-License-Identifier: MIT
#include "device/program.hpp"

#include <algorithm>
#include <cstdlib>
#include <regex>
#include <set>
#include <sstream>
#include <vector>

#include "device/cl_error.hpp"
#include "device/kernel_files.hpp"

namespace clpv {
namespace {

constexpr int kLinesRoundError = 2;         // shown before and after a faulty line
constexpr std::size_t kMaxErrorsShown = 3;  // later ones mostly follow from the first

/// Where a line of a program's text comes from, as its #line marks say.
struct Line {
  std::string file;
  int number = 0;
  std::string text;
};

std::vector<Line> numbered_lines(const std::string& text) {
  static const std::regex mark("#line ([0-9]+) \"(.*)\"");
  std::vector<Line> lines;
  std::istringstream in(text);
  std::string line, file;
  int number = 1;
  for (std::smatch match; std::getline(in, line);) {
    if (std::regex_match(line, match, mark)) {
      number = std::stoi(match[1]);
      file = match[2];
    } else {
      lines.push_back({file, number++, line});
    }
  }
  return lines;
}

std::string excerpt_round(const std::vector<Line>& lines, const Line& fault) {
  std::string excerpt = fault.file + ":\n";
  for (const Line& line : lines) {
    if (line.file != fault.file || std::abs(line.number - fault.number) > kLinesRoundError) continue;
    excerpt += fmt::format("{} {:4} | {}\n", line.number == fault.number ? '>' : ' ', line.number, line.text);
  }
  return excerpt;
}

}  // namespace

std::string program_text(const ProgramSource& source) {
  std::string text;
  if (!source.literals.defined().empty()) text += "#line 1 \"literals\"\n";
  for (const auto& [name, value] : source.literals.defined())
    text += fmt::format("#define {} {}\n", name, value);
  if (!source.generated.empty()) text += "#line 1 \"generated\"\n" + source.generated + "\n";
  return text + assemble_kernel_source(source.file);
}

std::string lines_round_errors(const std::string& text, const std::string& log) {
  // clang says "FILE:LINE:COLUMN: error: ...", PoCL "error: FILE:LINE:COLUMN: ..."; some put a folder before
  // FILE.
  static const std::regex fault(
      "error: ([^\\s:]+):([0-9]{1,9}):[0-9]+:|([^\\s:]+):([0-9]{1,9}):[0-9]+: (?:fatal )?error:");
  const std::vector<Line> lines = numbered_lines(text);
  std::set<std::pair<std::string, int>> shown;
  std::string excerpt;
  for (std::sregex_iterator found(log.begin(), log.end(), fault), end; found != end; ++found) {
    const int group = (*found)[1].matched ? 1 : 3;
    const std::string named = (*found)[group];
    const int number = std::stoi((*found)[group + 1]);
    const auto at = std::find_if(lines.begin(), lines.end(), [&](const Line& line) {
      return line.number == number && !line.file.empty() &&
             (named == line.file || named.ends_with("/" + line.file));
    });
    if (at == lines.end() || shown.size() >= kMaxErrorsShown || !shown.emplace(at->file, number).second)
      continue;
    excerpt += excerpt_round(lines, *at);
  }
  return excerpt;
}

namespace {

/// Of a build that fails without a word on the text: PoCL 3.1's does now and then where another process compiles the same
/// text for the first time, since both write to its cache.
constexpr int kMoreTries = 2;

/// The compiler's words; none where the driver has none either.
std::string build_log(const cl::Program& program, const Device& device) {
  try {
    return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.handle);
  } catch (const cl::Error& error) {
    return fmt::format("(no log: {})", cl_error_name(error.err()));
  }
}

}  // namespace

cl::Program build_program(const cl::Context& context, const Device& device, const ProgramSource& source,
                          const std::string& text) {
  for (int left = kMoreTries;; --left) {
    cl::Program program(context, text);
    try {
      program.build(device.handle, source.options.c_str());
      return program;
    } catch (const cl::Error& error) {
      const std::string log = build_log(program, device);
      if (left > 0 && log.find("error:") == std::string::npos) continue;
      throw Error(ExitCode::run_time, "kernels/{} does not build on {} (driver {}) with '{}': {}\n{}\n{}",
                  source.file, device.name, device.driver, source.options, cl_error_name(error.err()), log,
                  lines_round_errors(text, log));
    }
  }
}

}  // namespace clpv
