// SPDX-License-Identifier: MIT
#include "reference/carry_late.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace clpv::reference {
namespace {

/// The coarser cells whose centres are round a finer one's, along an axis, and the weight of the upper one.
struct Neighbours {
  int lower;
  double upper_weight;
};

Neighbours neighbours(const ClpvGrid& coarser, const ClpvGrid& finer, std::size_t axis, int cell) {
  const double centre = finer.origin[axis] + finer.cell * (cell + 0.5);    // [m]
  const double at = (centre - coarser.origin[axis]) / coarser.cell - 0.5;  // from the first coarser centre
  return {static_cast<int>(std::floor(at)), at - std::floor(at)};
}

}  // namespace

void carry_late(const Volume& light, const ClpvGrid& coarser, Volume& sum, const ClpvGrid& finer) {
  const double ratio = double{finer.cell} / coarser.cell, area = ratio * ratio;
  const auto share = [](const Neighbours& n, int upper) {
    return upper ? n.upper_weight : 1 - n.upper_weight;
  };
  for (int z = 0; z < sum.n; ++z) {
    for (int y = 0; y < sum.n; ++y) {
      for (int x = 0; x < sum.n; ++x) {
        const std::array<Neighbours, 3> round = {neighbours(coarser, finer, 0, x),
                                                 neighbours(coarser, finer, 1, y),
                                                 neighbours(coarser, finer, 2, z)};
        for (int corner = 0; corner < 8; ++corner) {
          const int ux = corner & 1, uy = (corner >> 1) & 1, uz = corner >> 2;
          const double weight = area * share(round[0], ux) * share(round[1], uy) * share(round[2], uz);
          for (int channel = 0; channel < sum.channels; ++channel) {
            for (int i = 0; i < sum.coefficients; ++i) {
              sum.at(channel, i, x, y, z) += weight * light.value(channel, i, round[0].lower + ux,
                                                                  round[1].lower + uy, round[2].lower + uz);
            }
          }
        }
      }
    }
  }
}

}  // namespace clpv::reference
