// SPDX-License-Identifier: MIT
// Pieces of straight-line OpenCL C with literal constants, for Basis::kernel_source() and the transports.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "basis/basis.hpp"

namespace clpv {

/// "fma(0.5f, x, fma(0.25f, y, 2.0f * z))": sum of factors[i] * names[i]. Factors below 1e-13 of the largest
/// are rounding errors of exact zeros and left out; "0.0f" where nothing remains.
std::string sum_of_products(std::span<const double> factors, const std::vector<std::string>& names);

/// Horner's form of sum_i coefficients[i] x^i, `x` a name.
std::string horner(std::span<const double> coefficients, const std::string& x);

/// How texts call the table that they take: as the macros CLPV_AND_TABLE and CLPV_PASS_TABLE of
/// pipeline/lookup_table.hpp have it, or for a second table beside it CLPV_AND_FUNCTIONS and CLPV_PASS_FUNCTIONS.
struct TableName {
  std::string macro = "TABLE", argument = "table";
};
inline const TableName kFunctionsTable{"FUNCTIONS", "functions"};

/// Both texts need a basis with centres, and the macros of pipeline/lookup_table.hpp before them. Tables of
/// `table_size` entries, one after the other, are read as ZonalTables are.
///
///   Coefficients clpv_rotated_integrals(x, y, z, table)   R c: integrals times b_i of the lobe towards +z, turned to
///                                                         the unit direction; the tables are gram_tables()'
std::string rotated_integrals_source(const Basis& basis, int table_size);
///   Coefficients clpv_table_basis(x, y, z, table)         b_i of a unit direction; the tables are function_tables()'
std::string table_basis_source(const Basis& basis, int table_size, const TableName& name = {});

}  // namespace clpv
