// SPDX-License-Identifier: MIT
// Generates straight-line OpenCL C: structs of a cell's numbers, and products with constant matrices that use
// symmetries.
//
// A reflection of the grid maps each basis function to plus or minus another one. In sum and difference coordinates,
// reflections only flip signs: most entries of a step's matrices are zero, and rows that mirror each other differ
// only in signs: a step of sh2 takes 36 multiply-adds instead of 110.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "basis/matrix.hpp"
#include "codegen/mirrors.hpp"

namespace clpv {

/// Floating-point operations of generated code.
struct OperationCount {
  int additions = 0;  ///< additions, subtractions, comparisons
  int multiplications = 0;
  int fused = 0;  ///< fma: two operations each
  int flops() const { return additions + multiplications + 2 * fused; }
};

/// List of statements `const realW NAME = ...;`. Equal expressions are written once.
class LinearCode {
 public:
  /// Appends statements for rows * inputs (inputs: expressions). Mirrors must be commuting symmetries of the inputs;
  /// those that do not exist are ignored. Returns one expression per row: a name, or "0.0f".
  std::vector<std::string> product(const Matrix& rows, const std::vector<std::string>& inputs,
                                   const std::vector<SignedPermutation>& mirrors = {});
  /// Returns the text of a function `called` that multiplies a struct `from` by `matrix` and returns a struct `to`.
  std::string function(const std::string& to, const std::string& called, const std::string& from,
                       const Matrix& matrix, const std::vector<SignedPermutation>& mirrors = {});
  /// Returns a name for a + b, a - b, or any expression with the given operations.
  std::string add(const std::string& a, const std::string& b);
  std::string subtract(const std::string& a, const std::string& b);
  std::string name(const std::string& expression, const OperationCount& cost);

  const std::string& text() const { return text_; }
  const OperationCount& operations() const { return operations_; }

 private:
  struct Term {
    double factor;
    std::string input;
  };
  std::string combination(const std::vector<Term>& terms);

  std::string text_;
  std::map<std::string, std::string> names_;
  OperationCount operations_;
};

/// "name.c0", "name.c1", ...: the scalars of a struct of cell_macros().
std::vector<std::string> fields(const std::string& name, int count);

/// `statements` as a macro. A function would prevent vectorisation of work-items in compilers that pass structs in
/// vector registers.
std::string macro_text(const std::string& name, const std::string& statements);

/// First generated text of kernels with coefficients: CLPV_N, the type Coefficient of one of them, `number`, struct
/// Coefficients of N of them, c0, c1, ..., and CLPV_EACH_COEFFICIENT(DO). `number`: "realW", those of W cells
/// (kernels/lanes.h), or "float" for kernels that read one cell at a time.
std::string coefficient_macros(int coefficients, const std::string& number = "realW");

/// struct `type` of `count` numbers c0, c1, ..., and CLPV_EACH_`each`(DO), which writes DO(0) DO(1) ...
std::string cell_macros(const std::string& type, const std::string& each, int count,
                        const std::string& number = "realW");

}  // namespace clpv
