// SPDX-License-Identifier: MIT
// Kernel source text, embedded at build time or read from the folder CLPV_KERNEL_DIR.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace clpv {

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
