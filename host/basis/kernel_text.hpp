// SPDX-License-Identifier: MIT
// Writers of straight-line OpenCL C with literal constants, for Basis::kernel_source() and the
// transports.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "basis/basis.hpp"

namespace clpv {

/// Returns sum_i factors[i] * names[i] as an expression: "fma(0.5f, x, fma(0.25f, y, 2.0f * z))".
/// Omits factors below 1e-13 of the largest, which are rounding errors of zeros. Returns "0.0f" for
/// an empty sum.
std::string sum_of_products(std::span<const double> factors, const std::vector<std::string>& names);

/// Returns sum_i coefficients[i] x^i in Horner's form, for the variable named `x`.
std::string horner(std::span<const double> coefficients, const std::string& x);

/// Name of a table parameter in kernel text: suffix of the macros CLPV_AND_* and CLPV_PASS_* of
/// pipeline/inject/lookup_table.hpp, and the parameter's name.
struct TableName {
  std::string macro = "TABLE", argument = "table";
};
inline const TableName kFunctionsTable{"FUNCTIONS", "functions"};

// Both functions require a basis with centres, and return text that requires the macros of
// pipeline/inject/lookup_table.hpp. `table_size`: entries per table; tables lie one after the
// other, as in ZonalTables::values().

/// Returns the function `Coefficients rotated_integrals(x, y, z, table)`: R c, the integrals of b_i
/// times the lobe rotated from +z to the unit direction (x, y, z), by gram_tables().
std::string rotated_integrals_source(const Basis& basis, int table_size);
/// Returns the function `Coefficients table_basis(x, y, z, table)`: b_i of a unit direction, by
/// function_tables().
std::string table_basis_source(const Basis& basis, int table_size, const TableName& name = {});

}  // namespace clpv
