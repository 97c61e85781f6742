// SPDX-License-Identifier: MIT
#include "pipeline/sweep/sweep_literals.hpp"

#include <algorithm>
#include <bit>

#include "basis/bounce.hpp"
#include "pipeline/steps/transmittance.hpp"

namespace clpv {
namespace {

constexpr int kMirrored = 8;  // bins about an axis
constexpr int kFolds = 3;     // log2 kMirrored

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

Literals source_literals(const Basis& basis) {
  Literals literals;
  add_coefficient_literals(literals, basis.size());
  return literals;
}

Literals sweep_links_literals(const Basis& basis, const Transport& transport) {
  const LinkVolumes volumes = link_volumes();
  std::vector<int> links;
  for (const std::vector<int>& across : volumes.across)
    links.insert(links.end(), across.begin(), across.end());
  return link_constants(basis, transport)
      .literals.integer("CLPV_AXIS_LINKS", volumes.across[0].size())
      .integers("CLPV_VOLUME_LINKS", links);
}

Literals sweep_collect_literals(double most_white) {
  const Matrix projection = folded(swept_projection());
  Literals literals;
  add_coefficient_literals(literals, projection.rows());
  return literals.matrix("CLPV_PROJECTION", transposed(projection))
      .real("CLPV_LEAST_OPEN", kLeastOpen)
      .real("CLPV_MOST_WHITE", most_white);
}

Literals bounce_literals(const Basis& basis) {
  return source_literals(basis)
      .matrix("CLPV_INCIDENT", incident_flux())
      .matrix("CLPV_LOBES", transposed(reflected_intensity(basis)))
      .flag("CLPV_BANDED", basis.bands() > 0)
      .real("CLPV_LEAST_SHARE", kLeastShare)
      .real("CLPV_LEAST_WHITE", kLeastWhite)
      .real("CLPV_MAX_RETURNED", kMaxReturned)
      .real("CLPV_RELAXATION", kRelaxation);
}

Literals scattering_literals(double anisotropy) {
  return Literals().matrix("CLPV_SCATTERING", axis_rows(folded(scattering_matrix(anisotropy))));
}

}  // namespace clpv
