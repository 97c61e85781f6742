// SPDX-License-Identifier: MIT
#include "support/literal.hpp"

#include <cmath>

#include "support/error.hpp"

namespace clpv {

std::string float_literal(double value) {
  const auto single = static_cast<float>(value);
  if (!std::isfinite(single)) throw Error(ExitCode::run_time, "no kernel literal for {}", value);
  std::string text = fmt::format("{:.9g}", single);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return std::signbit(single) ? "(" + text + "f)" : text + "f";
}

}  // namespace clpv
