// SPDX-License-Identifier: MIT
// OpenCL programs: what one is built from, its text, and building it.
#pragma once

#include <CL/opencl.hpp>
#include <string>

#include "device/device.hpp"
#include "device/literals.hpp"

namespace clpv {

/// Names what a kernel is built from: a file of kernels/, literals, and text made by the host (basis
/// functions, transport) that `#include "generated.h"`-style files refer to.
struct ProgramSource {
  std::string file;       ///< "propagate.cl"
  Literals literals;      ///< before everything else
  std::string generated;  ///< text placed after the literals and before the file
  std::string options = "-cl-std=CL1.2";
};

/// The whole text a driver compiles: literals, generated text, file with its includes, each after a #line
/// mark
/// ("literals", "generated", the file's name under kernels/). Throws Error(run_time) for an unknown file.
std::string program_text(const ProgramSource& source);

/// Compiles `text`, which is program_text(source), for the device.
/// Throws Error(run_time) with options and the compiler's log, which names lines by their #line marks.
cl::Program build_program(const cl::Context& context, const Device& device, const ProgramSource& source,
                          const std::string& text);

}  // namespace clpv
