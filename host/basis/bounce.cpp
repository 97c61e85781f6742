// SPDX-License-Identifier: MIT
#include "basis/bounce.hpp"

#include <algorithm>

#include "basis/sweep.hpp"

namespace clpv {
namespace {

/// Cosine between a side's normal and a bin's light, as it leaves the side; 0 for what does not.
double cosine(const SweepBin& bin, int side) {
  const int axis = side / 2;
  return std::max(0.0, (side % 2 == 0 ? 1 : -1) * bin.directions.front().w[axis]);
}

double lost_at_edges() {
  double both = 0, one = 0;  // of light that leaves up x, and up y too
  for (const SweepBin& bin : sweep_bins(1)) {
    const double x = cosine(bin, 0), y = cosine(bin, 2), flux = bin.directions.front().flux;
    one += bin.solid_angle * x;
    both += bin.solid_angle * x * y /
            flux;  // of the light across a plane, the share aside along x, along y, and along both
  }
  return both / (2 * one);
}

}  // namespace

Matrix arriving_flux() {
  const std::vector<SweepBin> bins = sweep_bins(1);
  Matrix flux(kReflectingSides, kSweepBins);
  for (int side = 0; side < kReflectingSides; ++side) {
    const int from = side ^ 1;  // light arrives the way that it would leave the opposite side
    for (int b = 0; b < kSweepBins; ++b) {
      const SweepBin& bin = bins[b];
      flux(side, b) = bin.solid_angle * cosine(bin, from);
    }
  }
  return flux;
}

Matrix leaving_light() {
  const std::vector<SweepBin> bins = sweep_bins(1);
  Matrix light(kSweepBins, kReflectingSides);
  for (int side = 0; side < kReflectingSides; ++side) {
    double all = 0;
    for (const SweepBin& bin : bins) all += bin.solid_angle * cosine(bin, side);
    for (int b = 0; b < kSweepBins; ++b) light(b, side) = cosine(bins[b], side) / all;
  }
  return light;
}

double edge_loss() {
  static const double loss = lost_at_edges();  // a quadrature, and the CPU reference asks in every cell
  return loss;
}

}  // namespace clpv
