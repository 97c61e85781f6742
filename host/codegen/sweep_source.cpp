// SPDX-License-Identifier: MIT
#include "codegen/sweep_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "basis/bounce.hpp"
#include "codegen/transmittance_source.hpp"

namespace clpv {
namespace {

constexpr int kMirrored = 8;  // bins about an axis
constexpr int kFolds = 3;     // log2 kMirrored

Matrix transposed(const Matrix& matrix) {
  Matrix result(matrix.columns(), matrix.rows());
  for (int r = 0; r < matrix.rows(); ++r) {
    for (int c = 0; c < matrix.columns(); ++c) result(c, r) = matrix(r, c);
  }
  return result;
}

/// The matrix by folded bins: `matrix` times bins is the result times fold_bins() of them
/// (kernels/sweep/mirrored_bins.h).
Matrix folded(const Matrix& matrix) {
  Matrix result(matrix.rows(), matrix.columns());
  for (int r = 0; r < matrix.rows(); ++r) {
    for (int b = 0; b < kSweepBins; ++b) {
      for (int j = 0; j < kMirrored; ++j) {
        const int odd = std::popcount(static_cast<unsigned>(b % kMirrored & j)) % 2;
        result(r, b) += (odd == 1 ? -1 : 1) * matrix(r, b - b % kMirrored + j) / kMirrored;
      }
    }
  }
  return result;
}

/// The rows of the first bin of each axis.
Matrix axis_rows(const Matrix& matrix) {
  Matrix result(kSweepBins / kMirrored, matrix.columns());
  for (int axis = 0; axis < result.rows(); ++axis)
    std::ranges::copy(matrix.row(kMirrored * axis), result.row(axis).begin());
  return result;
}

}  // namespace

std::string sweep_links_text(const Basis& basis, const Transport& transport) {
  const LinkVolumes volumes = link_volumes();
  std::vector<int> links;
  for (const std::vector<int>& across : volumes.across)
    links.insert(links.end(), across.begin(), across.end());
  return transmittance_source(basis, transport).text +
         fmt::format("#define CLPV_AXIS_LINKS {}\n", volumes.across[0].size()) +
         index_macro("CLPV_VOLUME_LINKS", links);
}

std::string sweep_collect_text() {
  const Matrix projection = folded(swept_projection());
  return coefficient_text(projection.rows()) +
         matrix_macro("CLPV_PROJECTION", transposed(projection));
}

OperationCount sweep_collect_operations() {
  return {.additions = kSweepBins * kFolds, .fused = products(folded(swept_projection()))};
}

std::string bounce_source_text(const Basis& basis) {
  return coefficient_text(basis.size()) + matrix_macro("CLPV_INCIDENT", incident_flux()) +
         matrix_macro("CLPV_LOBES", transposed(reflected_intensity(basis))) +
         fmt::format("#define CLPV_MAX_RETURNED {}f\n", kMaxReturned);
}

std::string scatter_source_text(double anisotropy) {
  return matrix_macro("CLPV_SCATTERING", axis_rows(folded(scattering_matrix(anisotropy))));
}

}  // namespace clpv
