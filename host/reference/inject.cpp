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

/// Area of the pixel's surface across its ray over the cell's: distance^2 x solid angle / s^2 in perspective.
double footprint_share(const ClpvView& view, std::size_t pixel, double depth, double cell) {
  const double area =
      4.0 * view.half_width * view.half_height / (static_cast<double>(view.width) * view.height);
  if (view.orthographic != 0) return area / (cell * cell);
  const glm::dvec3 eye(view.eye[0], view.eye[1], view.eye[2]);
  const glm::dvec3 p = surface_position(view, static_cast<double>(pixel % view.width),
                                        static_cast<double>(pixel / view.width), depth);
  const double distance = glm::length(p - eye), cosine = depth / distance;
  return distance * distance * area * cosine * cosine * cosine / (cell * cell);
}

glm::dvec3 ray(const ClpvView& view, std::size_t pixel) {
  const glm::dvec3 forward(view.forward[0], view.forward[1], view.forward[2]);
  if (view.orthographic != 0) return forward;
  const glm::dvec3 eye(view.eye[0], view.eye[1], view.eye[2]);
  const auto px = static_cast<double>(pixel % view.width), py = static_cast<double>(pixel / view.width);
  return glm::normalize(surface_position(view, px, py, 1.0) - eye);
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
    const double share =
        stride * stride * footprint_share(surface.view, pixel, surface.depth[pixel], grid.cell) / cosine;
    const glm::ivec3 corner(glm::floor(grid_point(surface, pixel, grid, false) + 0.5));
    if (!blocks_by_lobes(options.blocking)) {
      add(blocking, 0, corner, share, {std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
      continue;
    }
    add(blocking, 0, corner, share, lobes(normal));
  }
  return blocking;
}

std::vector<double> cell_of(const Volume& volume, int x, int y, int z) {
  std::vector<double> c;
  for (int i = 0; i < volume.coefficients; ++i) c.push_back(volume.value(0, i, x, y, z));
  return c;
}

}  // namespace

glm::dvec3 grid_point(const SurfaceImage& surface, std::size_t pixel, const ClpvGrid& grid, bool light) {
  const glm::dvec3 origin(grid.origin[0], grid.origin[1], grid.origin[2]);
  const auto px = static_cast<double>(pixel % surface.view.width);
  const auto py = static_cast<double>(pixel / surface.view.width);
  const glm::dvec3 p = surface.position.empty() ? surface_position(surface.view, px, py, surface.depth[pixel])
                                                : xyz(surface.position[pixel]);
  return (p - origin) / static_cast<double>(grid.cell) + (light ? 0.5 : 0.0) * xyz(surface.normal[pixel]);
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
  for (int z = 0; z < geometry.n; ++z) {
    for (int y = 0; y < geometry.n; ++y) {
      for (int x = 0; x < geometry.n; ++x) {
        const std::vector<double> c = cell_of(found, x, y, z), kept = cell_of(geometry, x, y, z);
        const bool areas = !blocks_by_lobes(blocking);
        if (!areas && basis.energy(c) <= basis.energy(kept)) continue;
        for (std::size_t i = 0; i < c.size(); ++i) {
          geometry.at(0, static_cast<int>(i), x, y, z) = areas ? std::max(c[i], kept[i]) : c[i];
        }
      }
    }
  }
}

void inject_geometry(const SurfaceImage& surface, const ClpvGrid& grid, const Basis& basis,
                     const InjectOptions& options, Volume& geometry, int stride) {
  merge_geometry(blocking_of(surface, grid, basis, options, stride), basis, options.blocking, geometry);
}

Volume otherwise_merged(const Volume& a, const Volume& b, const Basis& basis, Blocking blocking) {
  Volume other = a;
  merge_geometry(b, basis, blocking, other);
  if (!blocks_by_lobes(blocking)) return other;
  for (int z = 0; z < a.n; ++z) {
    for (int y = 0; y < a.n; ++y) {
      for (int x = 0; x < a.n; ++x) {
        const std::vector<double> of_a = cell_of(a, x, y, z), of_b = cell_of(b, x, y, z);
        const double in_a = basis.energy(of_a), in_b = basis.energy(of_b);
        if (std::abs(in_a - in_b) > kTie * std::max(in_a, in_b)) continue;
        const std::vector<double>& loser = in_b > in_a ? of_a : of_b;
        for (std::size_t i = 0; i < loser.size(); ++i) other.at(0, static_cast<int>(i), x, y, z) = loser[i];
      }
    }
  }
  return other;
}

}  // namespace clpv::reference
