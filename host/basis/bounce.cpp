// SPDX-License-Identifier: MIT
#include "basis/bounce.hpp"

#include <algorithm>
#include <numbers>
#include <numeric>
#include <span>

#include "basis/sweep.hpp"
#include "basis/transport.hpp"

namespace clpv {
namespace {

/// Cosine between a face's normal and a bin's direction; 0 if light of the bin does not leave the
/// face.
double cosine(const SweepBin& bin, int side) {
  const int axis = side / 2;
  return std::max(0.0, (side % 2 == 0 ? 1 : -1) * bin.directions.front().w[axis]);
}

}  // namespace

Matrix incident_flux() {
  const std::vector<SweepBin> bins = sweep_bins(1);
  Matrix flux(kCellFaces, kSweepBins);
  for (int side = 0; side < kCellFaces; ++side) {
    // Light arrives here in the directions in which it leaves the opposite face.
    const int opposite = side ^ 1;
    for (int b = 0; b < kSweepBins; ++b) {
      const SweepBin& bin = bins[b];
      flux(side, b) = bin.solid_angle * cosine(bin, opposite);
    }
    const std::span<double> row = flux.row(side);
    const double even = std::accumulate(row.begin(), row.end(), 0.0);
    for (double& each : row) each *= std::numbers::pi / even;
  }
  return flux;
}

Matrix reflected_intensity(const Basis& basis) {
  Matrix light(basis.size(), kCellFaces);
  for (int side = 0; side < kCellFaces; ++side) {
    const std::vector<double> cosine = basis.clamped_cosine(glm::dvec3(kAxes[side]));
    const double total = basis.energy(cosine);
    for (int i = 0; i < basis.size(); ++i) light(i, side) = cosine[i] / total;
  }
  return light;
}

}  // namespace clpv
