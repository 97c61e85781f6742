// SPDX-License-Identifier: MIT
// Pieces of straight-line OpenCL C with literal constants, for Basis::kernel_source() and the transports.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace clpv {

/// "fma(0.5f, x, fma(0.25f, y, 2.0f * z))": sum of factors[i] * names[i]. Factors below 1e-13 of the largest
/// are rounding errors of exact zeros and left out; "0.0f" where nothing remains.
std::string sum_of_products(std::span<const double> factors, const std::vector<std::string>& names);

/// Horner's form of sum_i coefficients[i] x^i, `x` a name.
std::string horner(std::span<const double> coefficients, const std::string& x);

}  // namespace clpv
