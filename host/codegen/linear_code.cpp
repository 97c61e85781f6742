// SPDX-License-Identifier: MIT
#include "codegen/linear_code.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/text.hpp"

namespace clpv {
namespace {

constexpr double kZero = 1e-12;  // relative to the largest entry: rounding of double sums of order 1

}  // namespace

std::string LinearCode::name(const std::string& expression, const OperationCount& cost) {
  const auto [entry, fresh] = names_.emplace(expression, fmt::format("v{}", names_.size()));
  if (fresh) {
    text_ += fmt::format("  const CLPV_REAL {} = {};\n", entry->second, expression);
    operations_.additions += cost.additions;
    operations_.multiplications += cost.multiplications;
    operations_.fused += cost.fused;
  }
  return entry->second;
}

std::string LinearCode::add(const std::string& a, const std::string& b) {
  if (a == "0.0f") return b;
  if (b == "0.0f") return a;
  return name(fmt::format("{} + {}", std::min(a, b), std::max(a, b)), {.additions = 1});
}

std::vector<std::string> LinearCode::product(const Matrix& rows, const std::vector<std::string>& inputs) {
  double largest = 0;
  for (int r = 0; r < rows.rows(); ++r) {
    for (const double factor : rows.row(r)) largest = std::max(largest, std::abs(factor));
  }
  std::vector<std::string> outputs;
  for (int r = 0; r < rows.rows(); ++r) {
    std::string sum;
    for (int i = 0; i < rows.columns(); ++i) {
      if (std::abs(rows(r, i)) <= kZero * largest) continue;
      const std::string factor = float_literal(rows(r, i));
      sum = sum.empty()
                ? name(fmt::format("{} * {}", factor, inputs[i]), {.multiplications = 1})
                : name(fmt::format("fma((CLPV_REAL)({}), {}, {})", factor, inputs[i], sum), {.fused = 1});
    }
    outputs.push_back(sum.empty() ? "0.0f" : sum);
  }
  return outputs;
}

std::string LinearCode::function(const std::string& to, const std::string& called, const std::string& from,
                                 const Matrix& matrix) {
  const std::vector<std::string> results = product(matrix, fields("a", matrix.columns()));
  std::string text =
      fmt::format("CLPV_INLINE {0} {1}(const {2} a) {{\n{3}  {0} r;\n", to, called, from, text_);
  for (std::size_t i = 0; i < results.size(); ++i) text += fmt::format("  r.c{} = {};\n", i, results[i]);
  return text + "  return r;\n}\n";
}

std::vector<std::string> fields(const std::string& name, int count) {
  std::vector<std::string> result;
  for (int i = 0; i < count; ++i) result.push_back(fmt::format("{}.c{}", name, i));
  return result;
}

std::string macro_text(const std::string& name, const std::string& statements) {
  std::string text = "#define " + name;
  for (const char c : statements) text += c == '\n' ? std::string(" \\\n") : std::string(1, c);
  return text + "\n\n";
}

std::string cell_macros(const std::string& type, const std::string& each, int count) {
  std::string list, fields;
  for (int i = 0; i < count; ++i) {
    list += fmt::format(" DO({})", i);
    fields += fmt::format("{} c{}", i == 0 ? "" : ",", i);
  }
  return fmt::format("#define CLPV_EACH_{}(DO){}\ntypedef struct {{\n  CLPV_REAL{};\n}} {};\n", each, list,
                     fields, type);
}

std::string coefficient_macros(int coefficients) {
  // Inlined by the compiler's front end: left to later passes, structs would be passed in memory or in vector registers,
  // and work-items would no longer vectorise on CPU devices.
  return "#define CLPV_INLINE static inline __attribute__((always_inline))\n"
         "#ifndef CLPV_LANES\n#define CLPV_LANES 1\n#endif\n"
         "#if CLPV_LANES == 8\n#define CLPV_REAL float8\n#else\n#define CLPV_REAL float\n#endif\n" +
         fmt::format("#define CLPV_N {}\n", coefficients) +
         cell_macros("Coefficients", "COEFFICIENT", coefficients);
}

}  // namespace clpv
