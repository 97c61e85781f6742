// SPDX-License-Identifier: MIT
#include "codegen/gather_source.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "basis/kernel_text.hpp"
#include "codegen/linear_code.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

constexpr double kNegligible =
    1e-12;  // quadrature's noise in a matrix whose entry is 0; the others are near 1

/// CLPV_EACH_PAIR: of an odd number of them the last is paired with zero. `member`: how one lane of a member is written.
std::string pair_macros(int count, const std::string& member) {
  std::string text = "#define CLPV_NONE(a) 0.0f\n", each = "#define CLPV_EACH_PAIR(DO)";
  for (int i = 0; i < count; ++i)
    text += fmt::format("#define CLPV_C{}(a) {}\n", i, fmt::format(fmt::runtime(member), i));
  for (int i = 0; i < count; i += 2) {
    const std::string odd = i + 1 < count ? fmt::format("CLPV_C{}", i + 1) : "CLPV_NONE";
    each += fmt::format(" DO({}, CLPV_C{}, {})", i / 2, i, odd);
  }
  return text + each + "\n";
}

std::string function(const std::string& declaration, const std::vector<double>& values) {
  std::string text = "CLPV_INLINE Coefficients " + declaration + " {\n  Coefficients g;\n";
  for (std::size_t i = 0; i < values.size(); ++i)
    text += fmt::format("  g.c{} = {};\n", i, float_literal(values[i]));
  return text + "  return g;\n}\n";
}

/// g(n), and M^T g(n) unless the volume holds M c.
std::string gather_weights(const GatherForm& form, bool packed, bool from_table) {
  const int count = form.functions().size();
  std::string text = "CLPV_INLINE Coefficients clpv_gather_weights(const float3 n CLPV_AND_TABLE) {\n";
  text += fmt::format("  Coefficients a = {};\n",
                      form.integrates() ? "clpv_cosine_integrals(-n.x, -n.y, -n.z)"
                      : from_table      ? "clpv_table_basis(-n.x, -n.y, -n.z CLPV_PASS_TABLE)"
                                        : "clpv_basis(-n.x, -n.y, -n.z)");
  if (form.window() > 0) {
    for (int i = 0; i < count; ++i) {
      text += fmt::format("  a.c{0} = fma({1}, a.c{0}, {2});\n", i, float_literal(1 - form.window()),
                          float_literal(form.window() * form.mean()[i]));
    }
  }
  if (packed) return text + "  return a;\n}\n";
  text += "  Coefficients g;\n";
  for (int j = 0; j < count; ++j) {
    std::string sum;
    for (int i = 0; i < count; ++i) {
      const double weight = form.matrix()(i, j);
      if (std::abs(weight) < kNegligible) continue;
      const std::string literal = float_literal(weight);
      sum = sum.empty() ? fmt::format("{} * a.c{}", literal, i)
                        : fmt::format("fma({}, a.c{}, {})", literal, i, sum);
    }
    text += fmt::format("  g.c{} = {};\n", j, sum.empty() ? "0.0f" : sum);
  }
  return text + "  return g;\n}\n";
}

}  // namespace

int packed_pairs(const GatherForm& form) {
  return (form.functions().size() + 1) / 2;
}

std::string pack_source(const Basis& basis, const GatherForm& form) {
  return coefficient_macros(basis.size()) + cell_macros("Gathered", "GATHERED", form.matrix().rows()) +
         pair_macros(form.matrix().rows(), "(((const float*)&(a).c{})[lane])") +
         LinearCode().function("Gathered", "clpv_gathered", "Coefficients", form.matrix());
}

std::string gather_source(const GatherForm& form, bool packed, bool from_table, const LobeOptions& lobes,
                          double floor) {
  const Basis& functions = form.functions();
  std::string text = coefficient_macros(functions.size()) + pair_macros(functions.size(), "(a).c{}") +
                     functions.kernel_source();
  if (from_table) text += table_basis_source(functions, lobes.table_size);
  text += gather_weights(form, packed, from_table);
  std::vector<double> least = packed ? form.mean() : form.matrix().transposed() * std::span(form.mean());
  for (double& value : least) value *= floor;
  return text + function("clpv_floor_weights(void)", least);
}

}  // namespace clpv
