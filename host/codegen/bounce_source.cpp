// SPDX-License-Identifier: MIT
#include "codegen/bounce_source.hpp"

#include <fmt/format.h>

#include "basis/bounce.hpp"
#include "basis/sweep.hpp"
#include "codegen/cell_macros.hpp"
#include "codegen/linear_code.hpp"
#include "codegen/sweep_source.hpp"

namespace clpv {
namespace {

/// A function from one struct to another: `matrix` times its fields.
std::string function_text(const char* to, const char* name, const char* from, const Matrix& matrix) {
  LinearCode code;
  const std::vector<std::string> results = code.product(matrix, fields("a", matrix.columns()), {});
  std::string text =
      fmt::format("CLPV_INLINE {} {}(const {} a) {{\n{}  {} r;\n", to, name, from, code.text(), to);
  for (std::size_t i = 0; i < results.size(); ++i) text += fmt::format("  r.c{} = {};\n", i, results[i]);
  return text + "  return r;\n}\n";
}

}  // namespace

std::string bounce_source_text() {
  return coefficient_macros(kReflectingSides) + sweep_bin_macros() +
         cell_macros("Swept", "SWEPT", kSweepBins) +
         function_text("Coefficients", "clpv_arriving", "Swept", arriving_flux()) +
         function_text("Swept", "clpv_leaving", "Coefficients", leaving_light());
}

std::string arriving_source_text() {
  return cell_macros("Sides", "SIDE", kReflectingSides) +
         function_text("Sides", "clpv_arriving", "Swept", arriving_flux());
}

}  // namespace clpv
