// SPDX-License-Identifier: MIT
// Straight-line OpenCL C: the structs of a cell's numbers, and products with constant matrices by their symmetries.
//
// A mirror image of the grid turns each basis function into plus or minus another one. In coordinates that
// such mirrors leave alone but for their sign (sums and differences of mirrored inputs) most entries of the
// step's matrices are zero, and rows that mirror each other have all but the signs in common: sh2's step
// takes 36 multiply-adds, not 110.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "basis/matrix.hpp"
#include "codegen/mirrors.hpp"

namespace clpv {

/// Floating-point operations a piece of generated code executes.
struct OperationCount {
  int additions = 0;  ///< additions, subtractions, comparisons
  int multiplications = 0;
  int fused = 0;  ///< fma: two operations each
  int flops() const { return additions + multiplications + 2 * fused; }
};

/// A list of statements `const CLPV_REAL NAME = ...;`. The same expression is never written twice.
class LinearCode {
 public:
  /// Statements for rows * inputs (inputs: expressions). Mirrors must be symmetries of the inputs, commuting; those that do
  /// not exist are ignored. Returns one expression a row: a name, or "0.0f".
  std::vector<std::string> product(const Matrix& rows, const std::vector<std::string>& inputs,
                                   const std::vector<SignedPermutation>& mirrors = {});
  /// The text of a function `called` that takes a struct `from` to a struct `to` by `matrix`.
  std::string function(const std::string& to, const std::string& called, const std::string& from,
                       const Matrix& matrix, const std::vector<SignedPermutation>& mirrors = {});
  /// A name for a + b, a - b, or any other expression, that costs the given operations.
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

/// "name.c0", "name.c1", ... : the scalars of a struct cell_macros() declares.
std::vector<std::string> fields(const std::string& name, int count);

/// `statements` as a macro. Not a function: compilers that pass structs in vector registers would keep work-items from
/// being vectorised.
std::string macro_text(const std::string& name, const std::string& statements);

/// Text every kernel that handles coefficients starts with (ProgramSource::generated): CLPV_INLINE, CLPV_LANES and
/// CLPV_REAL, CLPV_N, CLPV_EACH_COEFFICIENT(DO) and the struct Coefficients of N CLPV_REALs c0, c1, ...
std::string coefficient_macros(int coefficients);

/// The struct `type` of `count` CLPV_REALs c0, c1, ... and CLPV_EACH_`each`(DO), which writes DO(0) DO(1) ...
std::string cell_macros(const std::string& type, const std::string& each, int count);

}  // namespace clpv
