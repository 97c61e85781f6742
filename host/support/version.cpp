// SPDX-License-Identifier: MIT
// Version of the library and the program.
#include "clpv/version.hpp"

namespace clpv {

std::string version() {
  return CLPV_VERSION;
}

}  // namespace clpv
