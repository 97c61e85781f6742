// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace clpv {

/// That of the library linked, as "0.2.0". What is kept between runs (references, programs) is kept for one version.
std::string version();

}  // namespace clpv
