// SPDX-License-Identifier: MIT
#include "reference/cascade_sample.hpp"

#include <algorithm>
#include <cmath>

namespace clpv::reference {
namespace {

/// Linear interpolation along one axis: two cells and the weight of the upper one. Coordinates are
/// clamped to [0, n - 1].
struct LinearSample {
  int lower, upper;
  double t;
};

LinearSample linear_sample(double at, int n) {
  const double p = std::clamp(at, 0.0, n - 1.0);
  const int lower = std::min(static_cast<int>(std::floor(p)), std::max(n - 2, 0));
  return {lower, std::min(lower + 1, n - 1), p - lower};
}

constexpr int kPoints = 4;                       // visibility points per cube along each axis
constexpr double kMinVisibleShare = 1.0 / 64.0;  // by weight; below it, all cells count

int number_of(const glm::ivec3& at, int n) {
  return (at.z * n + at.y) * n + at.x;
}

/// Visible share of each of eight cells from a point `t` in their cube: visibility bits of the
/// points that see one of `clear`, interpolated trilinearly.
std::array<double, 8> visible_shares(const glm::dvec3& t, const std::uint8_t* points,
                                     unsigned clear) {
  std::array<LinearSample, 3> axes;
  for (int axis = 0; axis < 3; ++axis) axes[axis] = linear_sample(kPoints * t[axis] - 0.5, kPoints);
  std::array<double, 8> visible{};
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    int point = 0;
    double weight = 1;
    for (int axis = 2; axis >= 0; --axis) {
      const LinearSample& b = axes[axis];
      const bool upper = (i >> axis & 1) != 0;
      point = kPoints * point + (upper ? b.upper : b.lower);
      weight *= upper ? b.t : 1 - b.t;
    }
    const unsigned seen = ~unsigned{points[point]};
    if ((seen & clear) == 0) continue;
    sum += weight;
    for (std::size_t corner = 0; corner < 8; ++corner)
      visible[corner] += (seen >> corner & 1) != 0 ? weight : 0;
  }
  for (double& share : visible) share = sum > 0 ? share / sum : 0;
  return visible;
}

constexpr unsigned kAllCells = 255;

/// Cells of the cube, a bit each, of which a sample point must see one to count. `shift` is added
/// to the point along `clear` [quarters of a cell].
unsigned clear_cells(const glm::dvec3& at, const glm::ivec3& cube, const glm::dvec3& clear, int n,
                     const std::uint8_t* occluded, double shift = 0) {
  if (clear == glm::dvec3(0)) return kAllCells;
  const int last = std::max(kPoints * (n - 1) - 1, 0);
  const glm::dvec3 way = double{kPoints} * glm::clamp(at, 0.0, n - 1.0) + clear + shift;
  const glm::ivec3 point(glm::clamp(way, 0.0, double(last))), there = point / kPoints;
  const std::uint8_t bits = occluded[number_of(there, n) * kPoints * kPoints * kPoints +
                                     number_of(point % kPoints, kPoints)];
  unsigned cells = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 in_cube = there - cube + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    const bool shared = glm::all(glm::greaterThanEqual(in_cube, glm::ivec3(0))) &&
                        glm::all(glm::lessThanEqual(in_cube, glm::ivec3(1)));
    if (shared && (bits >> corner & 1) == 0) cells |= 1u << number_of(in_cube, 2);
  }
  return cells != 0 ? cells : kAllCells;
}

}  // namespace

TrilinearSample trilinear_sample(const glm::dvec3& at, int n) {
  const std::array<LinearSample, 3> axes = {linear_sample(at.x, n), linear_sample(at.y, n),
                                            linear_sample(at.z, n)};
  TrilinearSample sample{};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    sample.weight[corner] = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const LinearSample& b = axes[axis];
      const bool upper = (corner >> axis & 1) != 0;
      sample.cell[corner][axis] = upper ? b.upper : b.lower;
      sample.weight[corner] *= upper ? b.t : 1 - b.t;
    }
  }
  return sample;
}

bool rounding_decides(const glm::dvec3& at, const glm::dvec3& clear, int n,
                      const std::uint8_t* occluded) {
  constexpr double kUnsure = 1e-4;  // above single precision's error at the coordinates of a grid
  const glm::ivec3 cube = trilinear_sample(at, n).cell[0];
  return clear_cells(at, cube, clear, n, occluded, -kUnsure) !=
         clear_cells(at, cube, clear, n, occluded, kUnsure);
}

void apply_visibility(TrilinearSample& sample, const glm::dvec3& at, const glm::dvec3& clear, int n,
                      const std::uint8_t* occluded) {
  const glm::ivec3 cube = sample.cell[0];
  const glm::dvec3 t = glm::clamp(at, 0.0, n - 1.0) - glm::dvec3(cube);
  const int number = number_of(cube, n) * kPoints * kPoints * kPoints;
  const std::array<double, 8> visible =
      visible_shares(t, occluded + number, clear_cells(at, cube, clear, n, occluded));
  double total = 0;
  for (std::size_t corner = 0; corner < 8; ++corner)
    total += visible[corner] * sample.weight[corner];
  if (total <= kMinVisibleShare) return;
  for (std::size_t corner = 0; corner < 8; ++corner)
    sample.weight[corner] *= visible[corner] / total;
}

std::vector<double> interpolated(const Volume& volume, int channel, const TrilinearSample& sample) {
  std::vector<double> c(volume.coefficients, 0.0);
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const glm::ivec3& cell = sample.cell[corner];
    for (int i = 0; i < volume.coefficients; ++i) {
      c[i] += sample.weight[corner] * volume.value(channel, i, cell.x, cell.y, cell.z);
    }
  }
  return c;
}

double share_of(const glm::dvec3& position, const ClpvGrid& grid, int n, double blend_cells) {
  double distance = n;
  for (int axis = 0; axis < 3; ++axis) {
    const double off = std::abs(position[axis] - double{grid.middle[axis]}) / double{grid.cell};
    distance = std::min(distance, grid_reach(n) - off);
  }
  return std::clamp(distance / blend_cells, 0.0, 1.0);
}

}  // namespace clpv::reference
