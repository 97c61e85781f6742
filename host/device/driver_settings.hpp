// SPDX-License-Identifier: MIT
// Environment variables that change what OpenCL drivers do.
#pragma once

#include <string>

namespace clpv {

enum class DriverSettings {
  compilation,  ///< those that may change what kernels compute
  all           ///< also those that only change times, such as the number of threads
};

/// Returns "NAME=VALUE" of the variables that drivers read, by their prefixes, sorted, one a line;
/// caches are left out. Part of keys of programs, pixels and times.
std::string driver_settings(DriverSettings which);

}  // namespace clpv
