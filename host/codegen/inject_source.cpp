// SPDX-License-Identifier: MIT
#include "codegen/inject_source.hpp"

#include <fmt/format.h>

#include <cmath>
#include <span>
#include <vector>

#include "basis/kernel_text.hpp"
#include "codegen/constants.hpp"

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

std::string gram_text(const Matrix& gram) {
  const Matrix lower = cholesky(gram);
  std::vector<double> inverse_diagonal;
  for (int i = 0; i < lower.rows(); ++i) inverse_diagonal.push_back(1 / lower(i, i));
  return matrix_macro("CLPV_GRAM_LOWER", lower) +
         vector_macro("CLPV_GRAM_INVERSE_DIAGONAL", inverse_diagonal);
}

}  // namespace

std::string lobe_source(const Basis& basis, const LobeOptions& lobes) {
  // The flux of c = A^-1 alpha is integrals . A^-1 alpha, and A is symmetric.
  const std::vector<double> flux =
      basis.gram_inverse() * std::span<const double>(basis.integrals());
  const bool rotated = lobes.kind == LobeKind::rotate && !basis.centres().empty();
  return basis.kernel_source() +
         (rotated ? rotated_integrals_source(basis, lobes.table_size) : "") +
         fmt::format("#define CLPV_ROTATED {}\n", rotated ? 1 : 0) +
         vector_macro("CLPV_FLUX_WEIGHTS", flux) + gram_text(basis.gram());
}

std::string inject_source(const Basis& basis, const LobeOptions& lobes) {
  return coefficient_text(basis.size()) + lobe_source(basis, lobes);
}

std::string blocker_source(const Basis& basis, const LobeOptions& lobes, Blocking blocking) {
  const std::string text = coefficient_text(blocking_size(blocking, basis));
  switch (blocking) {
    case Blocking::areas:
      return text + "#define CLPV_BLOCKS_BY_AREA 1\n";
    case Blocking::one_sided:
      return text + "#define CLPV_BLOCKS_BY_AREA 0\n" +
             vector_macro("CLPV_INTEGRALS", basis.integrals()) + lobe_source(basis, lobes);
  }
  return text;
}

}  // namespace clpv
