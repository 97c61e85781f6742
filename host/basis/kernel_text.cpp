// SPDX-License-Identifier: MIT
#include "basis/kernel_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/text.hpp"

namespace clpv {

std::string sum_of_products(std::span<const double> factors, const std::vector<std::string>& names) {
  double largest = 0;
  for (const double factor : factors) largest = std::max(largest, std::abs(factor));
  std::string text;
  for (std::size_t i = factors.size(); i-- > 0;) {
    if (std::abs(factors[i]) <= 1e-13 * largest) continue;
    const std::string factor = float_literal(factors[i]);
    text = text.empty() ? fmt::format("{} * {}", factor, names[i])
                        : fmt::format("fma({}, {}, {})", factor, names[i], text);
  }
  return text.empty() ? "0.0f" : text;
}

std::string horner(std::span<const double> coefficients, const std::string& x) {
  std::string text = float_literal(coefficients.back());
  for (std::size_t i = coefficients.size() - 1; i-- > 0;) {
    text = coefficients[i] == 0 ? fmt::format("{} * {}", x, text)
                                : fmt::format("fma({}, {}, {})", x, text, float_literal(coefficients[i]));
  }
  return text;
}

}  // namespace clpv
