// SPDX-License-Identifier: MIT
// Volume of coefficients on the host, in double.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace clpv::reference {

/// n^3 samples: values[channel][coefficient][z][y][x]. value() returns 0 outside the grid.
struct Volume {
  int n = 0, coefficients = 0, channels = 3;
  std::vector<double> values;

  Volume() = default;
  Volume(int samples, int coefficient_count, int channel_count = 3)
      : n(samples),
        coefficients(coefficient_count),
        channels(channel_count),
        values(static_cast<std::size_t>(samples) * samples * samples * coefficient_count *
                   channel_count,
               0.0) {}

  std::size_t index(int channel, int i, int x, int y, int z) const {
    return ((((static_cast<std::size_t>(channel) * coefficients + i) * n + z) * n + y) * n) + x;
  }
  bool inside(int x, int y, int z) const {
    return x >= 0 && y >= 0 && z >= 0 && x < n && y < n && z < n;
  }
  double& at(int channel, int i, int x, int y, int z) { return values[index(channel, i, x, y, z)]; }
  double value(int channel, int i, int x, int y, int z) const {
    return inside(x, y, z) ? values[index(channel, i, x, y, z)] : 0.0;
  }
  /// Returns all coefficients of a channel at a sample.
  std::vector<double> cell(int channel, const glm::ivec3& p) const {
    std::vector<double> c(coefficients);
    for (int i = 0; i < coefficients; ++i) c[i] = value(channel, i, p.x, p.y, p.z);
    return c;
  }
  void set_cell(int channel, const glm::ivec3& p, const std::vector<double>& c) {
    for (int i = 0; i < coefficients; ++i) at(channel, i, p.x, p.y, p.z) = c[i];
  }
};

/// Calls visit(cell) for each of n^3 cells, x fastest.
template <typename Visit>
void for_each_cell(int n, Visit visit) {
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) visit(glm::ivec3(x, y, z));
    }
  }
}

}  // namespace clpv::reference
