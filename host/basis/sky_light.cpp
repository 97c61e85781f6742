// SPDX-License-Identifier: MIT
#include "basis/sky_light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "basis/sweep.hpp"

namespace clpv {
namespace {

constexpr int kPoints = 2048;  // minimum number of sample points along the horizon

/// Sample points per texel, for at least `points` over `texels`.
int points_per_texel(int texels, int points) {
  return (points + texels - 1) / texels;
}

}  // namespace

std::vector<glm::dvec3> sky_means(const Sky& sky, int parts) {
  const std::size_t count = kSweepBins * parts * parts;
  std::vector<glm::dvec3> sums(count, glm::dvec3(0));
  std::vector<double> angles(count, 0);
  const int across = points_per_texel(sky.width, kPoints),
            down = points_per_texel(sky.height, kPoints / 2);
  const int columns = sky.width * across, rows = sky.height * down;
  std::vector<glm::dvec2> horizontal;  // unit (x, z) of each column
  for (int x = 0; x < columns; ++x) {
    const glm::dvec3 level = sky.direction((x + 0.5) / across, sky.height / 2.0);
    horizontal.push_back(glm::normalize(glm::dvec2(level.x, level.z)));
  }
  for (int y = 0; y < rows; ++y) {
    const double top = std::cos(std::numbers::pi * y / rows),
                 bottom = std::cos(std::numbers::pi * (y + 1) / rows);
    const double up = (top + bottom) / 2, out = std::sqrt(1 - up * up);
    const double angle = 2 * std::numbers::pi / columns * (top - bottom);
    for (int x = 0; x < columns; ++x) {
      const glm::dvec2& heading = horizontal[x];
      const SubBin to = sub_bin_along(-glm::dvec3(out * heading.x, up, out * heading.y), parts);
      const std::size_t i = to.bin * parts * parts + to.part;
      const std::size_t texel = y / down * sky.width + x / across;
      sums[i] += angle * glm::dvec3(sky.texels[texel]);
      angles[i] += angle;
    }
  }
  // Sampled solid angles differ slightly from exact ones. The sky's mean fills the difference: this
  // keeps the sky's flux, and a uniform sky stays uniform.
  glm::dvec3 mean(0);
  for (const glm::dvec3& sum : sums) mean += sum / (4 * std::numbers::pi);
  const std::vector<SweepBin> bins = sweep_bins(parts);
  const std::size_t of_bin = parts * parts;
  for (std::size_t i = 0; i < count; ++i)
    sums[i] =
        mean + (sums[i] - angles[i] * mean) / bins[i / of_bin].directions[i % of_bin].solid_angle;
  return sums;
}

std::vector<float> swept_sky(const Sky& sky, int parts) {
  const std::vector<glm::dvec3> means = sky_means(sky, parts);
  const std::vector<SweepBin> bins = sweep_bins(parts);
  const std::size_t of_bin = parts * parts;
  std::vector<float> light;
  for (std::size_t b = 0; b < bins.size(); ++b) {
    for (int channel = 0; channel < 3; ++channel) {
      for (std::size_t part = 0; part < of_bin; ++part)
        light.push_back(
            static_cast<float>(means[b * of_bin + part][channel] * bins[b].directions[part].flux));
    }
  }
  return light;
}

}  // namespace clpv
