// SPDX-License-Identifier: MIT
// Version of the library.
#pragma once

#include <string>

namespace clpv {

/// Returns the version of the linked library, such as "0.2.0". Cached ground truths are valid for
/// one version.
std::string version();

}  // namespace clpv
