// SPDX-License-Identifier: MIT
#include "basis/kernel_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "basis/rotated_lobe.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

std::string opening(const char* function, const TableName& name) {
  return fmt::format(
      "CLPV_INLINE Coefficients {}(const float x, const float y, const float z CLPV_AND_{}) {{\n"
      "#pragma OPENCL FP_CONTRACT OFF\n"  // rounding of a table's index: ZonalTable
      "  Coefficients r;\n",
      function, name.macro);
}

/// Expression of centre . (x, y, z); `names`: names of x, y, z.
std::string height(const glm::dvec3& centre, const std::vector<std::string>& names) {
  const double factors[] = {centre.x, centre.y, centre.z};
  return sum_of_products(factors, names);
}

/// Expression of dot_in_float(centre, (x, y, z)); `names`: names of x, y, z.
std::string dot_product(const glm::dvec3& centre, const std::vector<std::string>& names) {
  std::string text;
  for (int i = 0; i < 3; ++i) {
    if (centre[i] == 0) continue;
    text += fmt::format("{}{} * {}", text.empty() ? "" : " + ", float_literal(centre[i]), names[i]);
  }
  return text;
}

/// Expression that reads table number `table` at the expression `t`. Halving is exact, so half of
/// size - 1 is one factor.
std::string entry(const std::string& t, std::size_t table, int table_size, const TableName& name) {
  const std::size_t first = table * static_cast<std::size_t>(table_size);
  return fmt::format("CLPV_TABLE_READ({}, {}clamp((int)(({} + 1.0f) * {}), 0, {}))", name.argument,
                     first == 0 ? "" : fmt::format("{} + ", first), t,
                     float_literal((table_size - 1) / 2.0), table_size - 1);
}

/// Statements of rotation_to(): the rotation of +z to (x, y, z).
constexpr const char* kRotation = R"(  const float square = fma(x, x, y * y);
  const float k = z < 0.0f ? (1.0f - z) / square : 1.0f / (1.0f + z);
  const int down = z < 0.0f && square == 0.0f;
  const float xx = down ? 1.0f : fma(k * y, y, z), xy = down ? 0.0f : -k * x * y;
  const float yy = down ? -1.0f : fma(k * x, x, z);
)";

}  // namespace

std::string sum_of_products(std::span<const double> factors,
                            const std::vector<std::string>& names) {
  double largest = 0;
  for (const double factor : factors) largest = std::max(largest, std::abs(factor));
  std::string text;
  for (std::size_t i = factors.size(); i-- > 0;) {
    if (std::abs(factors[i]) <= 1e-13 * largest) continue;
    const std::string factor = float_literal(factors[i]);
    text = text.empty() ? fmt::format("{} * {}", factor, names[i])
                        : fmt::format("fma({}, {}, {})", factor, names[i], text);
  }
  return text.empty() ? "0.0f" : text;
}

std::string horner(std::span<const double> coefficients, const std::string& x) {
  std::string text = float_literal(coefficients.back());
  for (std::size_t i = coefficients.size() - 1; i-- > 0;) {
    text = coefficients[i] == 0
               ? fmt::format("{} * {}", x, text)
               : fmt::format("fma({}, {}, {})", x, text, float_literal(coefficients[i]));
  }
  return text;
}

std::string rotated_integrals_source(const Basis& basis, int table_size) {
  const std::vector<double> up_lobe = basis.clamped_cosine({0, 0, 1});
  const Parameters products = gram_parameters(basis);
  std::string text = opening("rotated_integrals", {}) + kRotation;
  for (int j = 0; j < basis.size(); ++j) {
    const glm::dvec3& c = basis.centres()[j];
    text += fmt::format(
        "  const float x{0} = {1};\n  const float y{0} = {2};\n  const float z{0} = {3};\n", j,
        height(c, {"xx", "xy", "x"}), height(c, {"xy", "yy", "y"}),
        height(c, {"(-x)", "(-y)", "z"}));
  }
  for (int i = 0; i < basis.size(); ++i) {
    for (int j = 0; j < basis.size(); ++j) {
      const std::string t =
          dot_product(basis.centres()[i],
                      {fmt::format("x{}", j), fmt::format("y{}", j), fmt::format("z{}", j)});
      const std::size_t table = products.index[i * basis.size() + j];
      const std::string weight = float_literal(up_lobe[j]), value = entry(t, table, table_size, {});
      text += j == 0 ? fmt::format("  r.c[{}] = {} * {};\n", i, weight, value)
                     : fmt::format("  r.c[{0}] = fma({1}, {2}, r.c[{0}]);\n", i, weight, value);
    }
  }
  return text + "  return r;\n}\n";
}

std::string table_basis_source(const Basis& basis, int table_size, const TableName& name) {
  const Parameters lambdas = function_parameters(basis);
  std::string text = opening("table_basis", name);
  for (int i = 0; i < basis.size(); ++i) {
    const std::string t = dot_product(basis.centres()[i], {"x", "y", "z"});
    text += fmt::format("  r.c[{}] = {};\n", i, entry(t, lambdas.index[i], table_size, name));
  }
  return text + "  return r;\n}\n";
}

}  // namespace clpv
