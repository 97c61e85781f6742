// SPDX-License-Identifier: MIT
// E = 4 I(-n) / s^2 for face transports, E = alpha(-n) . c / s^2 for the sweep; c interpolated trilinearly at p + h s n.
#include "reference/gather.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/view.hpp"

namespace clpv::reference {
namespace {

/// Linear interpolation along one axis: two cells and the weight of the upper one. Coordinates are clamped to [0, n - 1].
struct LinearSample {
  int lower, upper;
  double t;
};

LinearSample linear_sample(double at, int n) {
  const double p = std::clamp(at, 0.0, n - 1.0);
  const int lower = std::min(static_cast<int>(std::floor(p)), std::max(n - 2, 0));
  return {lower, std::min(lower + 1, n - 1), p - lower};
}

/// Trilinear interpolation: eight cells and their weights.
struct TrilinearSample {
  std::array<glm::ivec3, 8> cell;
  std::array<double, 8> weight;
};

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

constexpr int kPoints = 4;                       // visibility points per cube along each axis
constexpr double kMinVisibleShare = 1.0 / 64.0;  // of the total weight; below it, all cells count

/// Visible share of each of eight cells from a point `t` in their cube: visibility bits, interpolated trilinearly.
std::array<double, 8> visible_shares(const glm::dvec3& t, const std::uint8_t* points) {
  std::array<LinearSample, 3> axes;
  for (int axis = 0; axis < 3; ++axis) axes[axis] = linear_sample(kPoints * t[axis] - 0.5, kPoints);
  std::array<double, 8> visible{};
  for (int i = 0; i < 8; ++i) {
    int point = 0;
    double weight = 1;
    for (int axis = 2; axis >= 0; --axis) {
      const LinearSample& b = axes[axis];
      const bool upper = (i >> axis & 1) != 0;
      point = kPoints * point + (upper ? b.upper : b.lower);
      weight *= upper ? b.t : 1 - b.t;
    }
    for (std::size_t corner = 0; corner < 8; ++corner)
      visible[corner] += (points[point] >> corner & 1) != 0 ? 0 : weight;
  }
  return visible;
}

/// Multiplies weights by the visible shares of the cells from `at`, and normalises them.
void apply_visibility(TrilinearSample& sample, const glm::dvec3& at, int n, const std::uint8_t* occluded) {
  const glm::ivec3 cube = sample.cell[0];
  const glm::dvec3 t = glm::clamp(at, 0.0, n - 1.0) - glm::dvec3(cube);
  const int number = ((cube.z * n + cube.y) * n + cube.x) * kPoints * kPoints * kPoints;
  const std::array<double, 8> visible = visible_shares(t, occluded + number);
  double total = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) total += visible[corner] * sample.weight[corner];
  if (total <= kMinVisibleShare) return;
  for (std::size_t corner = 0; corner < 8; ++corner) sample.weight[corner] *= visible[corner] / total;
}

/// Interpolated coefficients of one channel.
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

/// Weights g(n) of the coefficients: E s^2 = g(n) . c.
std::vector<double> gather_weights(const Basis& basis, TransportKind transport, const LobeOptions& lobes,
                                   const glm::dvec3& normal) {
  std::vector<double> weights(static_cast<std::size_t>(basis.size()));
  if (!has_faces(transport)) {
    basis.cosine_integrals(-normal, weights);
    return weights;
  }
  weights = evaluate(basis, lobes, -normal);
  for (double& weight : weights) weight *= 4;
  return weights;
}

/// E s^2 from one volume, clamped at 0.
glm::dvec3 irradiance(const Volume& volume, const TrilinearSample& sample,
                      const std::vector<double>& weights) {
  glm::dvec3 e(0);
  for (int channel = 0; channel < 3; ++channel)
    e[channel] = std::max(0.0, dot(weights, interpolated(volume, channel, sample)));
  return e;
}

/// Blend weight of a cascade at a point: 1 inside, 0 at and beyond the boundary of the cube about the eye that it lights.
double share_of(const glm::dvec3& position, const ClpvGrid& grid, int n, double blend_cells) {
  double distance = n;
  for (int axis = 0; axis < 3; ++axis) {
    const double off = std::abs(position[axis] - double{grid.middle[axis]}) / double{grid.cell};
    distance = std::min(distance, CLPV_GRID_REACH(n) - off);
  }
  return std::clamp(distance / blend_cells, 0.0, 1.0);
}

}  // namespace

glm::dvec3 gather(const Basis& basis, TransportKind transport, const GatherOptions& options,
                  const std::vector<Cascade>& cascades, const glm::dvec3& position,
                  const glm::dvec3& normal) {
  const std::vector<double> weights = gather_weights(basis, transport, options.lobes, normal);
  glm::dvec3 e(0);
  double rest = 1;  // weight of the coarser cascades
  for (const Cascade& cascade : cascades) {
    const ClpvGrid& grid = cascade.grid;
    const glm::dvec3 at = (position - vector(grid.origin)) / double{grid.cell};
    const double share = share_of(position, grid, options.grid, options.blend_cells);
    const glm::dvec3 point = at + options.gather_offset * normal - 0.5;  // the first cell's centre is at 0.5
    const double area = double{grid.cell} * grid.cell;
    TrilinearSample sample = trilinear_sample(point, options.grid);
    if (options.gather == Gathering::visible) apply_visibility(sample, point, options.grid, cascade.occluded);
    e += share * rest / area * irradiance(*cascade.accumulated, sample, weights);
    rest *= 1 - share;
  }
  return e;
}

std::vector<glm::dvec3> gather(const Basis& basis, TransportKind transport, const GatherOptions& options,
                               const std::vector<Cascade>& cascades, const SurfaceImage& camera) {
  std::vector<glm::dvec3> image(camera.depth.size(), glm::dvec3(0));
  for (std::size_t pixel = 0; pixel < image.size(); ++pixel) {
    const double depth = camera.depth[pixel];
    if (depth <= 0) continue;
    image[pixel] = gather(basis, transport, options, cascades, surface_position(camera.view, pixel, depth),
                          glm::dvec3(camera.normal[pixel]));
  }
  return image;
}

}  // namespace clpv::reference
