// SPDX-License-Identifier: MIT
#include "device/kernel_files.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <set>
#include <sstream>

#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/input_file.hpp"
#include "support/input_record.hpp"

namespace clpv {
namespace {

constexpr std::string_view kOnce = "#pragma once";
// Deeper than any kernel nests; stops a file that includes itself.
constexpr int kMaxIncludeDepth = 8;

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

/// Macro that guards a file with `#pragma once`: the text of "volume/soa.h" is joined under
/// CLPV_ONCE_volume_soa_h.
std::string guard_of(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return "CLPV_ONCE_" + name;
}

/// Returns kernel_file(name), or nothing for an unknown name.
std::optional<std::string> find_kernel_file(const std::string& name) {
  if (const char* folder = std::getenv("CLPV_KERNEL_DIR"); folder != nullptr && *folder != '\0') {
    if (auto text = file_bytes(std::string(folder) + "/" + name)) return text;
    if (!std::filesystem::is_directory(folder))
      throw Error(ExitCode::usage,
                  "CLPV_KERNEL_DIR: found '{}', allowed: a folder with kernel files", folder);
  }
  const auto& files = detail::embedded_kernel_files();
  const auto found = files.find(name);
  if (found == files.end()) return std::nullopt;
  return std::string(found->second);
}

/// Adds a file and those that it includes, each once.
void add_file(Fingerprint& print, const std::string& name, std::set<std::string>& added) {
  if (!added.insert(name).second) return;
  const auto text = find_kernel_file(name);
  print.add(name).add(text.has_value());
  if (!text) return;  // compiling a kernel that includes it fails by name
  print.add(*text);
  std::istringstream lines(*text);
  for (std::string line; std::getline(lines, line);)
    if (const std::string other = included_name(line); !other.empty())
      add_file(print, other, added);
}

void append_file(std::string& out, const std::string& name, int depth) {
  if (depth > kMaxIncludeDepth) {
    throw Error(ExitCode::run_time, "kernels/{}: includes nest deeper than {}", name,
                kMaxIncludeDepth);
  }
  const std::string text = kernel_file(name);
  const bool once = text.find(kOnce) != std::string::npos;
  if (once) out += fmt::format("#ifndef {0}\n#define {0}\n", guard_of(name));
  out += fmt::format("#line 1 \"{}\"\n", name);
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (const std::string other = included_name(line); !other.empty()) {
      append_file(out, other, depth + 1);
      out += fmt::format("#line {} \"{}\"\n", number + 1, name);
    } else {
      if (line != kOnce) out += line;
      out += '\n';
    }
  }
  if (once) out += "#endif\n";
}

}  // namespace

void record_kernel_files() {
  const char* folder = std::getenv("CLPV_KERNEL_DIR");
  if (folder == nullptr || *folder == '\0') return;
  for (const auto& [name, embedded] : detail::embedded_kernel_files())
    InputRecord::add({"CLPV_KERNEL_DIR", std::filesystem::path(folder) / name});
}

std::string kernel_file(const std::string& name) {
  auto text = find_kernel_file(name);
  if (!text) throw Error(ExitCode::run_time, "no kernel file named '{}'", name);
  return *std::move(text);
}

void add_kernels(Fingerprint& print) {
  std::set<std::string> added;
  for (const auto& [name, text] : detail::embedded_kernel_files()) add_file(print, name, added);
}

std::string assemble_kernel_source(const std::string& name) {
  std::string source;
  append_file(source, name, 0);
  return source;
}

}  // namespace clpv
