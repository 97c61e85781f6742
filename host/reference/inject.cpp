// SPDX-License-Identifier: MIT
#include "reference/inject.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "reference/view.hpp"

namespace clpv::reference {
namespace {

constexpr double kLeastCosine = 0.1;  // of a surfel seen edge-on
constexpr double kTie = 2e-3;         // of the energy: four times what halves round a coefficient by

glm::dvec3 xyz(const glm::vec4& v) {
  return {v.x, v.y, v.z};
}

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The lobe round `normal`, scaled to a flux of pi where asked for.
std::vector<double> lobe(const Basis& basis, const Lobes& lobes, const glm::dvec3& normal, bool unit_flux) {
  std::vector<double> c = lobes(normal);
  if (!unit_flux) return c;
  const double scale = std::numbers::pi / basis.energy(c);
  for (double& value : c) value *= scale;
  return c;
}

void add(Volume& volume, int channel, const glm::ivec3& cell, double weight, const std::vector<double>& c) {
  if (!volume.inside(cell.x, cell.y, cell.z)) return;
  for (std::size_t i = 0; i < c.size(); ++i) {
    volume.at(channel, static_cast<int>(i), cell.x, cell.y, cell.z) += weight * c[i];
  }
}

glm::dvec3 ray(const ClpvView& view, std::size_t pixel) {
  if (view.orthographic != 0) return vector(view.forward);
  return glm::normalize(surface_position(view, pixel, 1.0) - vector(view.eye));
}

bool has_surface(const SurfaceImage& surface, std::size_t pixel) {
  const glm::dvec3 normal = xyz(surface.normal[pixel]);
  if (!finite(normal) || glm::dot(normal, normal) == 0) return false;
  if (!surface.position.empty()) return finite(xyz(surface.position[pixel]));
  return surface.depth[pixel] > 0 && std::isfinite(surface.depth[pixel]);
}

/// One source's blocking shares, before it is merged with others.
Volume blocking_of(const SurfaceImage& surface, const ClpvGrid& grid, const Basis& basis,
                   const InjectOptions& options, int stride) {
  const Lobes lobes(basis, options.lobes);
  Volume blocking(static_cast<int>(grid.n) + 1, blocking_size(options.blocking, basis), 1);
  const std::size_t every = stride;
  for (std::size_t pixel = 0; pixel < surface.depth.size(); ++pixel) {
    const bool taken =
        pixel % surface.view.width % every == every / 2 && pixel / surface.view.width % every == every / 2;
    if (!taken || !has_surface(surface, pixel)) continue;
    const glm::dvec3 normal = xyz(surface.normal[pixel]);
    const double cosine = std::max(std::abs(glm::dot(normal, ray(surface.view, pixel))), kLeastCosine);
    const double share = stride * stride *
                         footprint(surface.view, pixel % surface.view.width, pixel / surface.view.width,
                                   surface.depth[pixel]) /
                         (double{grid.cell} * grid.cell * cosine);
    const glm::ivec3 corner(glm::floor(grid_point(surface, pixel, grid, false) + 0.5));
    if (!blocks_by_lobes(options.blocking)) {
      add(blocking, 0, corner, share, {std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
      continue;
    }
    add(blocking, 0, corner, share, lobes(normal));
  }
  return blocking;
}

}  // namespace

glm::dvec3 grid_point(const SurfaceImage& surface, std::size_t pixel, const ClpvGrid& grid, bool light) {
  const glm::dvec3 p = surface.position.empty() ? surface_position(surface.view, pixel, surface.depth[pixel])
                                                : xyz(surface.position[pixel]);
  return (p - vector(grid.origin)) / double{grid.cell} + (light ? 0.5 : 0.0) * xyz(surface.normal[pixel]);
}

void inject_light(const SurfaceImage& rsm, const ClpvGrid& grid, const Basis& basis,
                  const InjectOptions& options, Volume& light) {
  const Lobes lobes(basis, options.lobes);
  for (std::size_t pixel = 0; pixel < rsm.normal.size(); ++pixel) {
    const glm::dvec3 flux = xyz(rsm.colour[pixel]);
    if (!has_surface(rsm, pixel) || !finite(flux)) continue;
    const std::vector<double> c = lobe(basis, lobes, xyz(rsm.normal[pixel]), options.unit_flux_lobes);
    const glm::dvec3 point = grid_point(rsm, pixel, grid, true);
    for (int channel = 0; channel < 3; ++channel) {
      add(light, channel, glm::ivec3(glm::floor(point)), flux[channel] / std::numbers::pi, c);
    }
  }
}

void merge_geometry(const Volume& found, const Basis& basis, Blocking blocking, Volume& geometry) {
  for_each_cell(geometry.n, [&](const glm::ivec3& p) {
    const std::vector<double> c = found.cell(0, p), kept = geometry.cell(0, p);
    const bool areas = !blocks_by_lobes(blocking);
    if (!areas && basis.energy(c) <= basis.energy(kept)) return;
    for (int i = 0; i < found.coefficients; ++i)
      geometry.at(0, i, p.x, p.y, p.z) = areas ? std::max(c[i], kept[i]) : c[i];
  });
}

void inject_geometry(const SurfaceImage& surface, const ClpvGrid& grid, const Basis& basis,
                     const InjectOptions& options, Volume& geometry, int stride) {
  merge_geometry(blocking_of(surface, grid, basis, options, stride), basis, options.blocking, geometry);
}

Volume otherwise_merged(const Volume& a, const Volume& b, const Basis& basis, Blocking blocking) {
  Volume other = a;
  merge_geometry(b, basis, blocking, other);
  if (!blocks_by_lobes(blocking)) return other;
  for_each_cell(a.n, [&](const glm::ivec3& p) {
    const std::vector<double> of_a = a.cell(0, p), of_b = b.cell(0, p);
    const double in_a = basis.energy(of_a), in_b = basis.energy(of_b);
    if (std::abs(in_a - in_b) <= kTie * std::max(in_a, in_b)) other.set_cell(0, p, in_b > in_a ? of_a : of_b);
  });
  return other;
}

}  // namespace clpv::reference
