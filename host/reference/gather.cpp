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
  const int lower = static_cast<int>(std::floor(p));
  return {lower, std::min(lower + 1, n - 1), p - lower};
}

/// Coefficients of a channel, trilinear at `at`, in samples from the first.
std::vector<double> sample(const Volume& volume, int channel, const glm::dvec3& at) {
  const std::array<Between, 3> axes = {between(at.x, volume.n), between(at.y, volume.n),
                                       between(at.z, volume.n)};
  std::vector<double> c(static_cast<std::size_t>(volume.coefficients), 0.0);
  for (int corner = 0; corner < 8; ++corner) {
    int cell[3];
    double weight = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const Between& b = axes[static_cast<std::size_t>(axis)];
      const bool upper = (corner >> axis & 1) != 0;
      cell[axis] = upper ? b.upper : b.lower;
      weight *= upper ? b.t : 1 - b.t;
    }
    for (int i = 0; i < volume.coefficients; ++i) {
      c[static_cast<std::size_t>(i)] += weight * volume.value(channel, i, cell[0], cell[1], cell[2]);
    }
  }
  return c;
}

/// M^T g(n): what irradiance is in each coefficient, per s^2.
std::vector<double> gather_weights(const Basis& basis, const GatherForm& form, const LobeOptions& lobes,
                                   const glm::dvec3& normal) {
  const bool looked_up = !form.integrates() && !form.projects();
  const std::vector<double> f = looked_up ? evaluate(basis, lobes, -normal) : form.evaluate(-normal);
  return form.matrix().transposed() * std::span<const double>(form.windowed(f));
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// E s^2 of one volume, clamped and floored.
glm::dvec3 irradiance(const Volume& volume, const glm::dvec3& at, const std::vector<double>& weights,
                      const std::vector<double>& floor) {
  glm::dvec3 e(0);
  for (int channel = 0; channel < 3; ++channel) {
    const std::vector<double> c = sample(volume, channel, at);
    const double least = std::max(0.0, dot(floor, c));
    e[channel] = std::max(least, dot(weights, c));
  }
  return e;
}

/// How much of a cascade holds at a point, `at` in cells from its origin: 1 inside, 0 at the boundary and
/// beyond.
double share_of(const glm::dvec3& at, int n, double blend_cells) {
  double distance = n;
  for (int axis = 0; axis < 3; ++axis) distance = std::min({distance, at[axis], n - at[axis]});
  return std::clamp(distance / blend_cells, 0.0, 1.0);
}

}  // namespace

glm::dvec3 gather(const Basis& basis, const GatherForm& form, const GatherOptions& options,
                  const std::vector<Cascade>& cascades, const glm::dvec3& position,
                  const glm::dvec3& normal) {
  const std::vector<double> weights = gather_weights(basis, form, options.lobes, normal);
  std::vector<double> floor = form.matrix().transposed() * std::span<const double>(form.mean());
  for (double& weight : floor) weight *= options.floor;
  glm::dvec3 e(0);
  double left = 1;
  for (const Cascade& cascade : cascades) {
    const ClpvGrid& grid = cascade.grid;
    const glm::dvec3 at =
        (position - glm::dvec3(grid.origin[0], grid.origin[1], grid.origin[2])) / double{grid.cell};
    const double share = share_of(at, options.grid, options.blend_cells);
    const glm::dvec3 point = at + options.gather_offset * normal - 0.5;  // the first cell's centre is at 0.5
    const double area = double{grid.cell} * grid.cell;
    e += share * left / area * irradiance(*cascade.accumulated, point, weights, floor);
    left *= 1 - share;
  }
  return e;
}

std::vector<glm::dvec3> gather(const Basis& basis, const Transport& transport, const GatherOptions& options,
                               const std::vector<Cascade>& cascades, const SurfaceImage& camera) {
  const GatherForm form(basis, transport);
  std::vector<glm::dvec3> image(camera.depth.size(), glm::dvec3(0));
  for (std::size_t pixel = 0; pixel < image.size(); ++pixel) {
    const double depth = camera.depth[pixel];
    if (depth <= 0) continue;
    const auto x = static_cast<double>(pixel % camera.view.width),
               y = static_cast<double>(pixel / camera.view.width);
    image[pixel] = gather(basis, form, options, cascades, surface_position(camera.view, x, y, depth),
                          glm::dvec3(camera.normal[pixel]));
  }
  return image;
}

}  // namespace clpv::reference
