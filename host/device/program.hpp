// SPDX-License-Identifier: MIT
// OpenCL programs: their source, full text and build.
#pragma once

#include <CL/opencl.hpp>
#include <map>
#include <string>
#include <string_view>
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

// Kernel source text, embedded at build time or read from the folder CLPV_KERNEL_DIR.

class Fingerprint;

/// Adds the files of CLPV_KERNEL_DIR to the InputRecord.
void record_kernel_files();

/// Returns the text of kernels/NAME ("steps/propagate.cl", "volume/soa.h"): from CLPV_KERNEL_DIR if
/// that folder has the file, else the embedded copy. Throws Error(run_time) for an unknown name.
std::string kernel_file(const std::string& name);

/// Returns kernel_file(name) with each `#include "other"` replaced by that file's text (paths from
/// kernels/), and `#pragma once` by a guard. `#line` directives make compiler messages name the
/// original file and line. Drivers never see an include: several fail on paths with blanks, and
/// their caches miss changed files. Throws Error(run_time) for an unknown name and for includes
/// nested more than 8 deep.
std::string assemble_kernel_source(const std::string& name);

/// Adds the text of all kernel files to a hash, and of other files that they include from
/// CLPV_KERNEL_DIR. Throws Error(usage) as kernel_file().
void add_kernels(Fingerprint& print);

namespace detail {
const std::map<std::string, std::string_view>& embedded_kernel_files();
}

}  // namespace clpv
