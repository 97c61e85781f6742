// SPDX-License-Identifier: MIT
#include "clpv/version.hpp"

namespace clpv {

std::string version() {
  return CLPV_VERSION;
}

}  // namespace clpv
