// SPDX-License-Identifier: MIT
// Constants for kernels as text: matrices, and the types of a cell's numbers.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "basis/matrix.hpp"

namespace clpv {

/// `#define NAME {{...}, ...}`: the initialiser of an array of floats. Numbers below 1e-12 of the
/// largest are rounding errors of zeros and become 0, so that kernels can leave out their products.
std::string matrix_macro(const std::string& name, const Matrix& matrix);
std::string vector_macro(const std::string& name, std::span<const double> vector);
/// `#define NAME {...}` for integers.
std::string index_macro(const std::string& name, const std::vector<int>& numbers);

/// First generated text of kernels with coefficients: CLPV_N, the type Coefficient of one of them,
/// `number`, and struct Coefficients, an array c of N of them. `number`: "realW", those of W cells
/// (kernels/lanes.h), or "float" for kernels that read one cell at a time.
std::string coefficient_text(int coefficients, const std::string& number = "realW");

/// Floating-point operations of a kernel per cell.
struct OperationCount {
  int additions = 0;  ///< additions, subtractions, comparisons
  int multiplications = 0;
  int fused = 0;  ///< fma: two operations each
  int flops() const { return additions + multiplications + 2 * fused; }
};

/// Number of entries that matrix_macro() does not set to 0: multiply-adds of a product with
/// `matrix`.
int products(const Matrix& matrix);

}  // namespace clpv
