// SPDX-License-Identifier: MIT
#include "device/kernel_files.hpp"

#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "support/error.hpp"
#include "support/input_file.hpp"

namespace clpv {
namespace {

constexpr int kMaxIncludeDepth = 8;  // deeper than any kernel nests; stops a file that includes itself

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

/// Returns NAME of a line `#include "NAME"`; empty for other lines.
std::string included_name(std::string_view line) {
  line = trim(line);
  if (!line.starts_with("#include")) return {};
  const auto open = line.find('"');
  const auto close = line.rfind('"');
  if (open == std::string_view::npos || close == open) return {};
  return std::string(line.substr(open + 1, close - open - 1));
}

void append_file(std::string& out, const std::string& name, int depth) {
  if (depth > kMaxIncludeDepth) {
    throw Error(ExitCode::run_time, "kernels/{}: includes nest deeper than {}", name, kMaxIncludeDepth);
  }
  out += fmt::format("#line 1 \"{}\"\n", name);
  std::istringstream lines(kernel_file(name));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (const std::string other = included_name(line); !other.empty()) {
      append_file(out, other, depth + 1);
      out += fmt::format("#line {} \"{}\"\n", number + 1, name);
    } else {
      out += line;
      out += '\n';
    }
  }
}

}  // namespace

std::string kernel_file(const std::string& name) {
  if (const char* folder = std::getenv("CLPV_KERNEL_DIR"); folder != nullptr && *folder != '\0') {
    if (auto text = file_bytes(std::string(folder) + "/" + name)) return *text;
    if (!std::filesystem::is_directory(folder))
      throw Error(ExitCode::usage, "CLPV_KERNEL_DIR: found '{}', allowed: a folder with kernel files",
                  folder);
  }
  const auto& files = detail::embedded_kernel_files();
  const auto found = files.find(name);
  if (found == files.end()) throw Error(ExitCode::run_time, "no kernel file named '{}'", name);
  return std::string(found->second);
}

std::string assemble_kernel_source(const std::string& name) {
  std::string source;
  append_file(source, name, 0);
  return source;
}

}  // namespace clpv
