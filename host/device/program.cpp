// SPDX-License-Identifier: MIT
#include "device/program.hpp"

#include "device/cl_error.hpp"
#include "device/kernel_files.hpp"

namespace clpv {
namespace {

/// Retries of a build that fails without an error in the text. PoCL 3.1 fails so occasionally while another process
/// compiles the same text for the first time, because both write to PoCL's cache.
constexpr int kRetries = 2;

/// The compiler's log, or a note that the driver has none.
std::string build_log(const cl::Program& program, const Device& device) {
  try {
    return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device.handle);
  } catch (const cl::Error& error) {
    return fmt::format("(no log: {})", cl_error_name(error.err()));
  }
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

cl::Program build_program(const cl::Context& context, const Device& device, const ProgramSource& source,
                          const std::string& text) {
  for (int left = kRetries;; --left) {
    cl::Program program(context, text);
    try {
      program.build(device.handle, source.options.c_str());
      return program;
    } catch (const cl::Error& error) {
      const std::string log = build_log(program, device);
      if (left > 0 && log.find("error:") == std::string::npos) continue;
      throw Error(ExitCode::run_time, "kernels/{} does not build on {} (driver {}) with '{}': {}\n{}",
                  source.file, device.name, device.driver, source.options, cl_error_name(error.err()), log);
    }
  }
}

}  // namespace clpv
