// SPDX-License-Identifier: MIT
#include "pipeline/inject/lobe_literals.hpp"

#include <cmath>
#include <span>
#include <vector>

#include "pipeline/inject/lookup_table.hpp"

namespace clpv {
namespace {

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

}  // namespace

Literals lobe_literals(const Basis& basis, const LobeOptions& lobes) {
  // The flux of c = A^-1 alpha is integrals . A^-1 alpha, and A is symmetric.
  const std::vector<double> flux =
      basis.gram_inverse() * std::span<const double>(basis.integrals());
  const Matrix lower = cholesky(basis.gram());
  std::vector<double> inverse_diagonal;
  for (int i = 0; i < lower.rows(); ++i) inverse_diagonal.push_back(1 / lower(i, i));
  const bool rotated = lobes.kind == LobeKind::rotate && !basis.centres().empty();
  Literals literals;
  basis.add_literals(literals);
  literals.reals("CLPV_FLUX_WEIGHTS", flux)
      .matrix("CLPV_GRAM_LOWER", lower)
      .reals("CLPV_GRAM_INVERSE_DIAGONAL", inverse_diagonal)
      .flag("CLPV_ROTATED", rotated);
  if (rotated) {
    literals.reals("CLPV_UP_LOBE", basis.clamped_cosine({0, 0, 1}))
        .integers("CLPV_SINGULAR_PARTS", parts_of(gram_parameters(basis)));
  }
  return literals;
}

}  // namespace clpv
