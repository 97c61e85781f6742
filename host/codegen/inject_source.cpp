// SPDX-License-Identifier: MIT
#include "codegen/inject_source.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <vector>

#include "basis/kernel_text.hpp"
#include "codegen/linear_code.hpp"
#include "support/text.hpp"

namespace clpv {
namespace {

constexpr double kNegligible = 1e-12;  // rounding of the Gram matrix, below float precision

/// Lower triangle L of the Gram matrix A = L L^T.
Matrix cholesky(const Matrix& a) {
  Matrix lower(a.rows(), a.rows());
  for (int i = 0; i < a.rows(); ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = a(i, j);
      for (int k = 0; k < j; ++k) sum -= lower(i, k) * lower(j, k);
      lower(i, j) = i == j ? std::sqrt(sum) : sum / lower(j, j);
    }
  }
  return lower;
}

/// Text of a function that returns a constant weighted sum of coefficients.
std::string weighted_sum(const std::string& name, std::span<const double> weights) {
  std::string sum = "0.0f";
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum = fmt::format("fma({}, a.c{}, {})", float_literal(weights[i]), i, sum);
  }
  return fmt::format("static inline float {}(const Coefficients a) {{\n  return {};\n}}\n", name, sum);
}

/// One unknown of a triangular system: (right - sum of factor(j) * known(j)) / diagonal, j in [first, last).
template <typename Factor>
std::string unknown(std::string right, double diagonal, const char* known, int first, int last,
                    Factor factor) {
  for (int j = first; j < last; ++j) {
    if (std::abs(factor(j)) < kNegligible) continue;
    right = fmt::format("fma({}, {}{}, {})", float_literal(-factor(j)), known, j, right);
  }
  if (std::abs(diagonal - 1) < kNegligible) return right;
  return fmt::format("{} * ({})", float_literal(1 / diagonal), right);
}

/// project_sum: A^-1 as two triangular systems, A = L L^T. A float A^-1 would have 20x the rounding error for
/// srbf14.
std::string projection(const Basis& basis) {
  const int n = basis.size();
  const Matrix lower = cholesky(basis.gram());
  std::string text = "static inline Coefficients project_sum(const Coefficients a) {\n";
  for (int i = 0; i < n; ++i) {
    const auto row = [&](int j) { return lower(i, j); };
    text += fmt::format("  const float y{} = {};\n", i,
                        unknown(fmt::format("a.c{}", i), lower(i, i), "y", 0, i, row));
  }
  text += "  Coefficients r;\n";
  for (int i = n - 1; i >= 0; --i) {
    const auto column = [&](int j) { return lower(j, i); };
    text += fmt::format("  r.c{} = {};\n", i,
                        unknown(fmt::format("y{}", i), lower(i, i), "r.c", i + 1, n, column));
  }
  return text + "  return r;\n}\n";
}

std::string lobe_blockers(const Basis& basis, const LobeOptions& lobes) {
  return lobe_source(basis, lobes) + weighted_sum("blocked_energy", basis.integrals()) +
         "static inline Coefficients surfel_blocker(float x, float y, float z CLPV_AND_TABLE) {\n"
         "  return lobe_integrals(x, y, z CLPV_PASS_TABLE);\n}\n"
         "static inline Coefficients merge_blockers(const Coefficients a, const Coefficients b) {\n"
         "  return blocked_energy(a) > blocked_energy(b) ? a : b;\n}\n";
}

std::string area_blockers() {
  return "static inline Coefficients project_sum(const Coefficients a) { return a; }\n"
         "static inline Coefficients surfel_blocker(float x, float y, float z) {\n"
         "  const Coefficients b = {fabs(x), fabs(y), fabs(z)};\n  return b;\n}\n"
         "static inline Coefficients merge_blockers(const Coefficients a, const Coefficients b) {\n"
         "  const Coefficients r = {fmax(a.c0, b.c0), fmax(a.c1, b.c1), fmax(a.c2, b.c2)};\n  return r;\n}\n";
}

}  // namespace

std::string lobe_source(const Basis& basis, const LobeOptions& lobes) {
  // The flux of c = A^-1 alpha is integrals . A^-1 alpha, and A is symmetric.
  const std::vector<double> flux = basis.gram_inverse() * std::span<const double>(basis.integrals());
  std::string text = basis.kernel_source();
  if (lobes.kind == LobeKind::rotate && !basis.centres().empty()) {
    text += rotated_integrals_source(basis, lobes.table_size);
    text += "#define lobe_integrals rotated_integrals\n";
  } else {
    text += "#define lobe_integrals cosine_integrals\n";
  }
  text += weighted_sum("lobe_flux", flux);
  return text + projection(basis);
}

std::string inject_source(const Basis& basis, const LobeOptions& lobes) {
  return coefficient_macros(basis.size()) + lobe_source(basis, lobes);
}

std::string blocker_source(const Basis& basis, const LobeOptions& lobes, Blocking blocking) {
  const std::string macros = coefficient_macros(blocking_size(blocking, basis));
  switch (blocking) {
    case Blocking::areas:
      return macros + area_blockers();
    case Blocking::one_sided:
      return macros + lobe_blockers(basis, lobes);
  }
  return macros;
}

}  // namespace clpv
