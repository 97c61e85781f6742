// SPDX-License-Identifier: MIT
#include "basis/bounce.hpp"

#include <algorithm>

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

double compute_edge_loss() {
  double both = 0, one = 0;  // flux through +x and +y, flux through +x
  for (const SweepBin& bin : sweep_bins(1)) {
    const double x = cosine(bin, 0), y = cosine(bin, 2), flux = bin.directions.front().flux;
    one += bin.solid_angle * x;
    both += bin.solid_angle * x * y / flux;
  }
  return both / (2 * one);
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

double edge_loss() {
  // Cached: the CPU reference calls this for every cell.
  static const double loss = compute_edge_loss();
  return loss;
}

}  // namespace clpv
