// SPDX-License-Identifier: MIT
#include "support/refuse.hpp"

#include "support/error.hpp"

namespace clpv {

void refuse(const std::string& file, std::string_view place, std::string_view found,
            std::string_view allowed) {
  throw Error(ExitCode::bad_input, "{}: {}{}found {}; allowed: {}", file, place, place.empty() ? "" : ": ",
              found, allowed);
}

}  // namespace clpv
