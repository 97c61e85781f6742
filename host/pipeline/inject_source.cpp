#include "pipeline/inject_source.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "device/session.hpp"
#include "pipeline/volume.hpp"

namespace clpv {
namespace {

constexpr double kNegligible =
    1e-12;  // below any single-precision coefficient beside it: rounding of A's inverse

/// A function that is a fixed weighted sum of coefficients.
std::string weighted_sum(const std::string& name, std::span<const double> weights, double scale) {
  std::string sum = "0.0f";
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum = fmt::format("fma({}, a.c{}, {})", float_literal(weights[i] * scale), i, sum);
  }
  return fmt::format("static inline float {}(const Coefficients a) {{\n  return {};\n}}\n", name, sum);
}

/// Sum and clpv_project_sum: A^-1 for 8 cells at once.
std::string eight_cells(const Basis& basis) {
  std::string text = "typedef struct {\n  float8";
  for (int i = 0; i < basis.size(); ++i) text += fmt::format("{} c{}", i == 0 ? "" : ",", i);
  text += ";\n} Sum;\nstatic inline Sum clpv_project_sum(const Sum a) {\n  Sum r;\n";
  for (int i = 0; i < basis.size(); ++i) {
    std::string sum;
    for (int j = 0; j < basis.size(); ++j) {
      const double entry = basis.gram_inverse()(i, j);
      if (std::abs(entry) < kNegligible) continue;
      const std::string factor = fmt::format("(float8)({})", float_literal(entry));
      sum = sum.empty() ? fmt::format("{} * a.c{}", factor, j)
                        : fmt::format("fma({}, a.c{}, {})", factor, j, sum);
    }
    text += fmt::format("  r.c{} = {};\n", i, sum);
  }
  return text + "  return r;\n}\n";
}

}  // namespace

std::string inject_source(const Basis& basis, bool trilinear) {
  // The flux of c = A^-1 alpha is integrals . A^-1 alpha, and A is symmetric.
  const std::vector<double> flux = basis.gram_inverse() * std::span<const double>(basis.integrals());
  std::string text = coefficient_macros(basis.size()) + basis.kernel_source();
  text += "#define clpv_lobe_integrals clpv_cosine_integrals\n";
  text += weighted_sum("clpv_flux", flux, 1.0);
  text += weighted_sum("clpv_mean", basis.integrals(), 0.25 * std::numbers::inv_pi);
  if (trilinear) text += eight_cells(basis);
  return text;
}

std::size_t inject_keys(int grid, bool trilinear, bool geometry) {
  const auto n = static_cast<std::size_t>(grid);
  if (trilinear) {
    const std::size_t half = n / 2 + 1;
    return 8 * half * half * half;
  }
  const std::size_t keys = geometry ? n + 1 : n;
  return keys * keys * keys;
}

}  // namespace clpv
