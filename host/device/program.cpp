// SPDX-License-Identifier: MIT
#include "device/program.hpp"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <thread>

#include "device/cl_error.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"
#include "support/input_file.hpp"
#include "support/log.hpp"

namespace clpv {
namespace {

constexpr std::string_view kOnce = "#pragma once";
// Deeper than any kernel nests; stops a file that includes itself.
constexpr int kMaxIncludeDepth = 8;

/// Returns NAME of a line `#include "NAME"`; empty for other lines.
std::string included_name(std::string_view line) {
  const auto first = std::min(line.find_first_not_of(" \t"), line.size());
  if (!line.substr(first).starts_with("#include")) return {};
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

/// Retries of a build that fails without an error in the text. PoCL 3.1 fails so occasionally while
/// another process compiles the same text, because both write to PoCL's cache. Waits double from
/// kRetryWait on.
constexpr int kRetries = 5;
constexpr std::chrono::milliseconds kRetryWait{20};

constexpr std::string_view kStandard = "-cl-std=CL1.2 ";
constexpr const char* kImageProbe =
    "__kernel void probe(__read_only image3d_t image, __global float4* texel) {\n"
    "  texel[0] = read_imagef(image, (int4)(0));\n"
    "}\n";

/// The compiler's log, or a note that the driver has none.
std::string build_log(const cl::Program& program, const Device& device) {
  try {
    return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.handle);
  } catch (const cl::Error& error) {
    return fmt::format("(no log: {})", cl_error_name(error.err()));
  }
}

bool compiles(const cl::Context& context, const Device& device, const char* text,
              const std::string& options) {
  try {
    cl::Program(context, text).build(device.handle, options.c_str());
    return true;
  } catch (const cl::Error&) {
    return false;
  }
}

/// Returns true if the driver compiles kernels with images only without -cl-std=CL1.2, as PoCL 7.1
/// does. Compiles a probe, once per driver.
bool lacks_images_in_standard(const cl::Context& context, const Device& device) {
  static std::mutex mutex;
  static std::map<std::string, bool> known;
  const std::scoped_lock lock(mutex);
  const std::string driver = fmt::format("{} {}", device.platform_version, device.driver);
  if (const auto found = known.find(driver); found != known.end()) return found->second;
  const bool lacks = device.images &&
                     !compiles(context, device, kImageProbe, std::string(kStandard)) &&
                     compiles(context, device, kImageProbe, "");
  if (lacks)
    log_debug("driver {} has images only without {}: programs that need them are built so",
              device.driver, kStandard);
  return known[driver] = lacks;
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

std::string program_text(const ProgramSource& source) {
  std::string text;
  if (!source.literals.defined().empty()) text += "#line 1 \"literals\"\n";
  for (const auto& [name, value] : source.literals.defined())
    text += fmt::format("#define {} {}\n", name, value);
  return text + assemble_kernel_source(source.file);
}

cl::Program build_program(const cl::Context& context, const Device& device,
                          const ProgramSource& source, const std::string& text) {
  // A log blames a line of the text by "inject.cl:12:3: error:", or "error: inject.cl:12:3" of PoCL
  // 6. Other errors are the driver's own.
  static const std::regex blame(":[0-9]+: (fatal )?error:|error: [^\n]*:[0-9]+:[0-9]+");
  std::string options = source.options;
  for (int left = kRetries;;) {
    cl::Program program(context, text);
    try {
      program.build(device.handle, options.c_str());
      return program;
    } catch (const cl::Error& error) {
      const std::string log = build_log(program, device);
      if (!std::regex_search(log, blame) && left > 0) {
        std::this_thread::sleep_for(kRetryWait * (1 << (kRetries - left--)));
      } else if (options.starts_with(kStandard) && lacks_images_in_standard(context, device)) {
        options.erase(0, kStandard.size());
      } else {
        throw Error(ExitCode::run_time,
                    "kernels/{} does not build on {} (driver {}) with '{}': {}\n{}", source.file,
                    device.name, device.driver, options, cl_error_name(error.err()), log);
      }
    }
  }
}

}  // namespace clpv
