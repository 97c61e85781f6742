// SPDX-License-Identifier: MIT
// OpenCL programs: their source, full text and build.
#pragma once

#include <CL/opencl.hpp>
#include <string>
#include <utility>

#include "device/device.hpp"
#include "support/literals.hpp"

namespace clpv {

/// Source of a program: a file of kernels/ and literals.
struct ProgramSource {
  ProgramSource(std::string kernel_file = {}, Literals defined = {})
      : file(std::move(kernel_file)), literals(std::move(defined)) {}

  std::string file;   ///< "steps/propagate.cl"
  Literals literals;  ///< placed first: sizes, choices and tables
  /// Tests show warnings; users could do nothing about them.
  std::string options = "-cl-std=CL1.2 -w";
};

/// Returns the full text that a driver compiles: literals, and the file with its includes. Each
/// section starts with a #line directive ("literals", the file's name under kernels/). Throws
/// Error(run_time) for an unknown file.
std::string program_text(const ProgramSource& source);

/// Compiles `text` = program_text(source) for the device, and again without -cl-std=CL1.2 if that
/// fails and the driver supports images only without it. Throws Error(run_time) with the options
/// and the compiler's log, which numbers lines by the #line directives.
cl::Program build_program(const cl::Context& context, const Device& device,
                          const ProgramSource& source, const std::string& text);

}  // namespace clpv
