// SPDX-License-Identifier: MIT
// The text of the kernels: embedded at build time, or read from CLPV_KERNEL_DIR.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace clpv {

/// Text of kernels/NAME ("propagate.cl", "volume/soa.h"), from the folder CLPV_KERNEL_DIR where that is set
/// and has it, else the embedded copy. Throws Error(run_time) for an unknown name.
std::string kernel_file(const std::string& name);

/// kernel_file(name) with each `#include "other"` replaced by that file's text (paths from kernels/), `#line`
/// marks before each part, so that compiler messages name the file and line that a person edits.
/// Drivers never see an include: several fail on paths with blanks, and their caches miss changed files.
std::string assemble_kernel_source(const std::string& name);

namespace detail {
const std::map<std::string, std::string_view>& embedded_kernel_files();
}

}  // namespace clpv
