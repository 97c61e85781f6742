// SPDX-License-Identifier: MIT
#include "reference/cascade_sample.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "basis/bounce.hpp"

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

const double kEvenLight = 2 * std::sqrt(std::numbers::pi);  // coefficient of band 0
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

constexpr unsigned kAllPoints = 511;  // cells that none lacks: every sample point counts

/// A sample point, by its cube and its place there, and the cells of the cube that it sees, a bit
/// each.
struct ClearPoint {
  glm::ivec3 cube, place;
  unsigned seen = 0;
};

/// The sample point at `at` [cells]. `shift` is added to it [quarters of a cell].
ClearPoint sample_point(const glm::dvec3& at, int n, const std::uint8_t* occluded,
                        double shift = 0) {
  const int last = std::max(kPoints * (n - 1) - 1, 0);
  const glm::ivec3 point(glm::clamp(double{kPoints} * at + shift, 0.0, double(last)));
  ClearPoint found{point / kPoints, point % kPoints};
  if (occluded != nullptr)
    found.seen = ~unsigned{occluded[number_of(found.cube, n) * kPoints * kPoints * kPoints +
                                    number_of(found.place, kPoints)]} &
                 255U;
  return found;
}

/// 0.85 cells along `clear` [cells] from `at`, or its end; nothing without a way.
std::optional<glm::dvec3> clear_place(const glm::dvec3& at, const glm::dvec3& clear, int n) {
  constexpr double kMost = 0.85;  // [cells]; below 1: the point is at most one cube away
  const double length = glm::length(clear);
  if (length == 0) return std::nullopt;
  return glm::clamp(at, 0.0, n - 1.0) + clear * std::min(1.0, kMost / length);
}

/// Where the sample point next to a clear_place() along each axis of `eye` is the nearest.
glm::dvec3 next_place(const glm::dvec3& place, const glm::dvec3& eye) {
  return place + 0.5 / double{kPoints} * glm::sign(eye);
}

/// Makes the sample one of the cells that a sample point sees, if it sees any.
void use_point(TrilinearSample& sample, const ClearPoint& point, int n) {
  if (point.seen == 0) return;
  sample = trilinear_sample(
      glm::dvec3(point.cube) + (glm::dvec3(point.place) + 0.5) / double{kPoints}, n);
  double total = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    sample.weight[corner] *= point.seen >> corner & 1;
    total += sample.weight[corner];
  }
  for (double& weight : sample.weight) weight /= total;
}

/// The cells that it sees as cells of `cube`.
unsigned cells_from(const ClearPoint& point, const glm::ivec3& cube) {
  unsigned cells = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 in_cube =
        point.cube - cube + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    const bool shared = glm::all(glm::greaterThanEqual(in_cube, glm::ivec3(0))) &&
                        glm::all(glm::lessThanEqual(in_cube, glm::ivec3(1)));
    if (shared && (point.seen >> corner & 1) != 0) cells |= 1u << number_of(in_cube, 2);
  }
  return cells;
}

TrilinearSample visible_sample(const glm::dvec3& at, const ClearWay& clear, double cell, int n,
                               const std::uint8_t* occluded, const Volume& light) {
  TrilinearSample sample = trilinear_sample(at, n);
  const glm::ivec3 cube = sample.cell[0];
  const glm::dvec3 t = glm::clamp(at, 0.0, n - 1.0) - glm::dvec3(cube);
  const int number = number_of(cube, n) * kPoints * kPoints * kPoints;
  std::optional<ClearPoint> point, next;
  if (const auto place = clear_place(at, clear.way / cell, n)) {
    point = sample_point(*place, n, occluded);
    next = sample_point(next_place(*place, clear.eye), n, occluded);
    if (point->seen == 0) point = next;
  }
  const std::array<double, 8> visible = visible_shares(
      t, occluded + number, point && point->seen != 0 ? cells_from(*point, cube) : kAllPoints);
  double total = 0;
  for (std::size_t corner = 0; corner < 8; ++corner)
    total += visible[corner] * sample.weight[corner];
  if (total > kMinVisibleShare) {
    for (std::size_t corner = 0; corner < 8; ++corner)
      sample.weight[corner] *= visible[corner] / total;
  } else if (point) {
    use_point(sample, *point, n);
  }
  constexpr double kLeastOpen = 0.5;  // least_open of kernels/gather/gather_packed.h
  if (next && light.channels > 3 && interpolated(light, 3, sample)[0] < kLeastOpen * kEvenLight)
    use_point(sample, *next, n);
  return sample;
}

glm::dvec4 weighed(const std::vector<double>& weights, const RadianceField& field) {
  return {dot(weights, field[0]), dot(weights, field[1]), dot(weights, field[2]),
          dot(weights, field[3])};
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

bool rounding_decides(const glm::dvec3& at, int n) {
  constexpr double kUnsure = 1e-4;  // above single precision's error at the coordinates of a grid
  const ClearPoint below = sample_point(at, n, nullptr, -kUnsure),
                   above = sample_point(at, n, nullptr, kUnsure);
  return below.cube != above.cube || below.place != above.place;
}

bool rounding_decides(const glm::dvec3& at, const ClearWay& clear, double cell, int n) {
  const std::optional<glm::dvec3> place = clear_place(at, clear.way / cell, n);
  return place &&
         (rounding_decides(*place, n) || rounding_decides(next_place(*place, clear.eye), n));
}

bool see_a_cell(const glm::dvec3& a, const glm::dvec3& b, int n, const std::uint8_t* occluded) {
  const ClearPoint p = sample_point(a, n, occluded), q = sample_point(b, n, occluded);
  const glm::ivec3 apart = glm::abs(q.cube - p.cube);
  return std::max({apart.x, apart.y, apart.z}) > 1 || (p.seen & cells_from(q, p.cube)) != 0;
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

TrilinearSample sample_of(const GatherOptions& options, const Cascade& cascade,
                          const glm::dvec3& at, const ClearWay& clear) {
  if (options.gather != Gathering::visible) return trilinear_sample(at, options.grid);
  return visible_sample(at, clear, cascade.grid.cell, options.grid, cascade.occluded,
                        *cascade.accumulated);
}

RadianceField radiance_field(const GatherOptions& options, const std::vector<Cascade>& cascades,
                             int coefficients, const glm::dvec3& position, double offset,
                             const glm::dvec3& lift, const ClearWay& clear) {
  RadianceField field;
  for (auto& channel : field) channel.assign(coefficients, 0.0);
  double rest = 1;  // weight of the coarser cascades
  for (const Cascade& cascade : cascades) {
    const ClpvGrid& grid = cascade.grid;
    const double share = share_of(position, grid, options.grid, options.blend_cells);
    const glm::dvec3 at =
        (position - vector(grid.origin)) / double{grid.cell} + offset * lift - 0.5;
    const TrilinearSample sample = sample_of(options, cascade, at, clear);
    for (int channel = 0; channel < 4 && share * rest > 0; ++channel) {
      const double weight = share * rest / (channel < 3 ? double{grid.cell} * grid.cell : 1);
      const std::vector<double> c = interpolated(*cascade.accumulated, channel, sample);
      for (int i = 0; i < coefficients; ++i) field[channel][i] += weight * c[i];
    }
    rest *= 1 - share;
  }
  field[3][0] += rest * kEvenLight;
  return field;
}

glm::dvec3 radiance(const Basis& basis, const RadianceField& field, const glm::dvec3& w) {
  std::vector<double> y(static_cast<std::size_t>(basis.size()));
  basis.evaluate(w, y);
  const glm::dvec4 light = weighed(y, field),
                   even = y[0] * glm::dvec4(field[0][0], field[1][0], field[2][0], field[3][0]);
  const double f = std::max(light.w, 0.0), rest = std::max(0.5 - f, 0.0);
  return (glm::dvec3(light) + rest * glm::dvec3(even) / over_furnace(even.w)) / (f + rest);
}

glm::dvec4 raw_irradiance(const Basis& basis, const RadianceField& field,
                          const glm::dvec3& normal) {
  std::vector<double> alpha(static_cast<std::size_t>(basis.size()));
  basis.cosine_integrals(-normal, alpha);
  return glm::max(weighed(alpha, field), 0.0);
}

glm::dvec3 field_irradiance(const Basis& basis, const RadianceField& field,
                            const glm::dvec3& normal) {
  const glm::dvec4 light = raw_irradiance(basis, field, normal);
  return glm::dvec3(light) / over_furnace(light.w / std::numbers::pi);
}

}  // namespace clpv::reference
