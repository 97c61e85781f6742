// SPDX-License-Identifier: MIT
#include "codegen/constants.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "support/text.hpp"

namespace clpv {
namespace {

// Relative to the largest entry: rounding of double sums of order 1.
constexpr double kZero = 1e-12;

double negligible(std::span<const double> numbers) {
  double largest = 0;
  for (const double number : numbers) largest = std::max(largest, std::abs(number));
  return kZero * largest;
}

double negligible(const Matrix& matrix) {
  double most = 0;
  for (int r = 0; r < matrix.rows(); ++r) most = std::max(most, negligible(matrix.row(r)));
  return most;
}

std::string initialiser(std::span<const double> numbers, double least) {
  std::vector<std::string> texts;
  for (const double number : numbers)
    texts.push_back(float_literal(std::abs(number) > least ? number : 0));
  return fmt::format("{{{}}}", fmt::join(texts, ", "));
}

}  // namespace

std::string matrix_macro(const std::string& name, const Matrix& matrix) {
  const double least = negligible(matrix);
  std::vector<std::string> rows;
  for (int r = 0; r < matrix.rows(); ++r) rows.push_back(initialiser(matrix.row(r), least));
  return fmt::format("#define {} {{{}}}\n", name, fmt::join(rows, ", \\\n  "));
}

std::string vector_macro(const std::string& name, std::span<const double> vector) {
  return fmt::format("#define {} {}\n", name, initialiser(vector, negligible(vector)));
}

std::string index_macro(const std::string& name, const std::vector<int>& numbers) {
  return fmt::format("#define {} {{{}}}\n", name, fmt::join(numbers, ", "));
}

std::string coefficient_text(int coefficients, const std::string& number) {
  return fmt::format(
      "#define CLPV_N {}\n"
      "typedef {} Coefficient;\n"
      "typedef struct {{\n  Coefficient c[CLPV_N];\n}} Coefficients;\n",
      coefficients, number);
}

int products(const Matrix& matrix) {
  const double least = negligible(matrix);
  int count = 0;
  for (int r = 0; r < matrix.rows(); ++r) {
    for (const double number : matrix.row(r)) count += std::abs(number) > least ? 1 : 0;
  }
  return count;
}

}  // namespace clpv
