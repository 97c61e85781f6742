// SPDX-License-Identifier: MIT
#include "reference/gather.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "reference/view.hpp"

namespace clpv::reference {
namespace {

/// The two samples of an axis round a coordinate, and the weight of the upper one; the outermost ones hold
/// beyond.
struct Between {
  int lower, upper;
  double t;
};

Between between(double at, int n) {
  const double p = std::clamp(at, 0.0, n - 1.0);
  const int lower = std::min(static_cast<int>(std::floor(p)), std::max(n - 2, 0));
  return {lower, std::min(lower + 1, n - 1), p - lower};
}

/// The eight samples round a point.
struct Around {
  std::array<glm::ivec3, 8> cell;
  std::array<double, 8> weight;
};

Around around(const glm::dvec3& at, int n) {
  const std::array<Between, 3> axes = {between(at.x, n), between(at.y, n), between(at.z, n)};
  Around found{};
  for (std::size_t corner = 0; corner < 8; ++corner) {
    found.weight[corner] = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const Between& b = axes[axis];
      const bool upper = (corner >> axis & 1) != 0;
      found.cell[corner][axis] = upper ? b.upper : b.lower;
      found.weight[corner] *= upper ? b.t : 1 - b.t;
    }
  }
  return found;
}

constexpr int kPoints = 4;                 // of a cube between centres, along each axis
constexpr double kLeastSeen = 1.0 / 64.0;  // of all weight; where less is seen nothing is known

/// How much of each cell is seen from a point: bits of the points of its cube, trilinearly.
std::array<double, 8> seen_from(const glm::dvec3& t, const std::uint8_t* points) {
  std::array<Between, 3> axes;
  for (int axis = 0; axis < 3; ++axis) axes[axis] = between(kPoints * t[axis] - 0.5, kPoints);
  std::array<double, 8> seen{};
  for (int i = 0; i < 8; ++i) {
    int point = 0;
    double weight = 1;
    for (int axis = 2; axis >= 0; --axis) {
      const Between& b = axes[axis];
      const bool upper = (i >> axis & 1) != 0;
      point = kPoints * point + (upper ? b.upper : b.lower);
      weight *= upper ? b.t : 1 - b.t;
    }
    for (std::size_t corner = 0; corner < 8; ++corner)
      seen[corner] += (points[point] >> corner & 1) != 0 ? 0 : weight;
  }
  return seen;
}

/// Takes the weight of the cells that are hidden from `at`.
void hide(Around& around, const glm::dvec3& at, int n, const std::uint8_t* hidden) {
  const glm::ivec3 cube = around.cell[0];
  const glm::dvec3 t = glm::clamp(at, 0.0, n - 1.0) - glm::dvec3(cube);
  const int number = ((cube.z * n + cube.y) * n + cube.x) * kPoints * kPoints * kPoints;
  const std::array<double, 8> seen = seen_from(t, hidden + number);
  double total = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) total += seen[corner] * around.weight[corner];
  if (total <= kLeastSeen) return;
  for (std::size_t corner = 0; corner < 8; ++corner) around.weight[corner] *= seen[corner] / total;
}

/// Coefficients of a channel.
std::vector<double> sample(const Volume& volume, int channel, const Around& around) {
  std::vector<double> c(volume.coefficients, 0.0);
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const glm::ivec3& cell = around.cell[corner];
    for (int i = 0; i < volume.coefficients; ++i) {
      c[i] += around.weight[corner] * volume.value(channel, i, cell.x, cell.y, cell.z);
    }
  }
  return c;
}

/// g(n): what irradiance is in each coefficient, per s^2.
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

/// E s^2 of one volume, clamped.
glm::dvec3 irradiance(const Volume& volume, const Around& around, const std::vector<double>& weights) {
  glm::dvec3 e(0);
  for (int channel = 0; channel < 3; ++channel)
    e[channel] = std::max(0.0, dot(weights, sample(volume, channel, around)));
  return e;
}

/// How much of a cascade holds at a point: 1 inside, 0 at the boundary of what is sure to lie in it round the eye, and beyond.
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
  double left = 1;
  for (const Cascade& cascade : cascades) {
    const ClpvGrid& grid = cascade.grid;
    const glm::dvec3 at = (position - vector(grid.origin)) / double{grid.cell};
    const double share = share_of(position, grid, options.grid, options.blend_cells);
    const glm::dvec3 point = at + options.gather_offset * normal - 0.5;  // the first cell's centre is at 0.5
    const double area = double{grid.cell} * grid.cell;
    Around cells = around(point, options.grid);
    if (options.gather == Gathering::visible) hide(cells, point, options.grid, cascade.hidden);
    e += share * left / area * irradiance(*cascade.accumulated, cells, weights);
    left *= 1 - share;
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
