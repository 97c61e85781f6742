// SPDX-License-Identifier: MIT
#include "reference/inject.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "reference/materials.hpp"
#include "reference/view.hpp"

namespace clpv::reference {

namespace {

constexpr double kMinCosine = 0.1;  // for a surfel seen edge-on
constexpr double kTie = 2e-3;       // relative energy: 4x the rounding error of half precision

glm::dvec3 xyz(const glm::vec4& v) {
  return {v.x, v.y, v.z};
}

bool finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The lobe about `normal`; with `unit_flux` scaled to a flux of pi.
std::vector<double> lobe(const Basis& basis, const Lobes& lobes, const glm::dvec3& normal,
                         bool unit_flux) {
  std::vector<double> c = lobes(normal);
  if (!unit_flux) return c;
  const double scale = std::numbers::pi / basis.energy(c);
  for (double& value : c) value *= scale;
  return c;
}

void add(Volume& volume, int channel, const glm::ivec3& cell, double weight,
         const std::vector<double>& c) {
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

/// Sum of all surfels of one source, before merging.
Volume blocking_of(const SurfaceImage& surface, const ClpvGrid& grid, const Basis& basis,
                   const InjectOptions& options, int stride) {
  const Lobes lobes(basis, options.lobes);
  Volume blocking(static_cast<int>(grid.n) + 1, blocking_size(options.blocking, basis), 1);
  const std::size_t every = stride;
  for (std::size_t pixel = 0; pixel < surface.depth.size(); ++pixel) {
    const bool sampled = pixel % surface.view.width % every == every / 2 &&
                         pixel / surface.view.width % every == every / 2;
    if (!sampled || !has_surface(surface, pixel)) continue;
    const glm::dvec3 normal = xyz(surface.normal[pixel]);
    const double cosine =
        std::max(std::abs(glm::dot(normal, ray(surface.view, pixel))), kMinCosine);
    const double share = stride * stride *
                         footprint(surface.view, pixel % surface.view.width,
                                   pixel / surface.view.width, surface.depth[pixel]) /
                         (double{grid.cell} * grid.cell * cosine);
    const glm::ivec3 corner(glm::floor(grid_point(surface, pixel, grid) + 0.5));
    if (!blocks_by_lobes(options.blocking)) {
      add(blocking, 0, corner, share, {std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
      continue;
    }
    add(blocking, 0, corner, share, lobes(normal));
  }
  return blocking;
}

}  // namespace

glm::dvec3 grid_point(const SurfaceImage& surface, std::size_t pixel, const ClpvGrid& grid) {
  const glm::dvec3 p = surface.position.empty()
                           ? surface_position(surface.view, pixel, surface.depth[pixel])
                           : xyz(surface.position[pixel]);
  return (p - vector(grid.origin)) / double{grid.cell};
}

glm::dvec3 light_point(const SurfaceImage& surface, std::size_t pixel, const ClpvGrid& grid,
                       bool in_front) {
  const glm::dvec3 n = xyz(surface.normal[pixel]), part = glm::abs(n) / 2.0;
  return grid_point(surface, pixel, grid) + (in_front ? part.x + part.y + part.z : 0.5) * n;
}

std::optional<glm::ivec3> nearest_in_sight(const glm::dvec3& point, int n,
                                           const std::uint8_t* occluded) {
  const glm::dvec3 at = point - 0.5;  // [cells] from the first centre
  const glm::ivec3 base(glm::floor(4.0 * at - 0.5));
  const auto sees = [&](const glm::ivec3& cell) {
    for (int i = 0; i < 8; ++i) {
      const glm::ivec3 sample = glm::clamp(base + glm::ivec3(i & 1, i >> 1 & 1, i >> 2),
                                           glm::ivec3(0), glm::ivec3(4 * n - 5)),
                       cube = sample / 4, place = sample % 4, corner = cell - cube;
      if (glm::any(glm::greaterThan(glm::abs(2 * corner - 1), glm::ivec3(1)))) return false;
      const int number = (cube.z * n + cube.y) * n + cube.x,
                bit = corner.x + 2 * corner.y + 4 * corner.z;
      if ((occluded[64 * number + 16 * place.z + 4 * place.y + place.x] >> bit & 1) != 0)
        return false;
    }
    return true;
  };
  std::optional<glm::ivec3> nearest;
  double least = 6.75;  // from half a cell beyond the outermost centres, 1.5 cells along each axis
  for_each_cell(n, [&](const glm::ivec3& cell) {
    const glm::dvec3 off = glm::dvec3(cell) - at;
    if (glm::dot(off, off) > least || !sees(cell)) return;
    least = glm::dot(off, off), nearest = cell;
  });
  return nearest;
}

void inject_light(const SurfaceImage& rsm, const ClpvGrid& grid, const Basis& basis,
                  const InjectOptions& options, const std::uint8_t* occluded, Volume& light) {
  const Lobes lobes(basis, options.lobes);
  for (std::size_t pixel = 0; pixel < rsm.normal.size(); ++pixel) {
    const glm::dvec3 flux = xyz(rsm.colour[pixel]);
    if (!has_surface(rsm, pixel) || !finite(flux)) continue;
    const std::vector<double> c =
        lobe(basis, lobes, xyz(rsm.normal[pixel]), options.unit_flux_lobes);
    const glm::dvec3 point = light_point(rsm, pixel, grid, options.in_front);
    glm::ivec3 cell(glm::floor(point));
    if (!light.inside(cell.x, cell.y, cell.z)) continue;
    if (occluded != nullptr) {
      const std::optional<glm::ivec3> seen = nearest_in_sight(point, light.n, occluded);
      if (!seen && rsm.position.empty()) continue;
      cell = seen.value_or(cell);
    }
    for (int channel = 0; channel < 3; ++channel)
      add(light, channel, cell, flux[channel] / std::numbers::pi, c);
  }
}

void merge_geometry(const Volume& found, const Basis& basis, Blocking blocking, Volume& geometry) {
  for_each_cell(geometry.n, [&](const glm::ivec3& p) {
    const std::vector<double> c = found.cell(0, p), old = geometry.cell(0, p);
    const bool areas = !blocks_by_lobes(blocking);
    if (!areas && basis.energy(c) <= basis.energy(old)) return;
    for (int i = 0; i < found.coefficients; ++i)
      geometry.at(0, i, p.x, p.y, p.z) = areas ? std::max(c[i], old[i]) : c[i];
  });
}

void inject_geometry(const SurfaceImage& surface, const ClpvGrid& grid, const Basis& basis,
                     const InjectOptions& options, Volume& geometry, int stride) {
  merge_geometry(blocking_of(surface, grid, basis, options, stride), basis, options.blocking,
                 geometry);
}

Volume merged_against_ties(const Volume& a, const Volume& b, const Basis& basis,
                           Blocking blocking) {
  Volume merged = a;
  merge_geometry(b, basis, blocking, merged);
  if (!blocks_by_lobes(blocking)) return merged;
  for_each_cell(a.n, [&](const glm::ivec3& p) {
    const std::vector<double> c_a = a.cell(0, p), c_b = b.cell(0, p);
    const double energy_a = basis.energy(c_a), energy_b = basis.energy(c_b);
    if (std::abs(energy_a - energy_b) <= kTie * std::max(energy_a, energy_b))
      merged.set_cell(0, p, energy_b > energy_a ? c_a : c_b);
  });
  return merged;
}

namespace {

/// A triangle inside another, similar to it or (edge < 0) inverted. Corner and edge are in the
/// outer triangle's barycentric coordinates.
struct SubTriangle {
  glm::dvec2 corner{0};
  double edge = 1;

  glm::dvec2 centroid() const { return corner + edge / 3; }

  /// Divides the triangle into rows^2 similar ones, row by row from the first corner.
  std::vector<SubTriangle> divided(int rows) const {
    std::vector<SubTriangle> sub_triangles;
    const double step = edge / rows;
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column <= row; ++column) {
        sub_triangles.push_back({corner + step * glm::dvec2(row - column, column), step});
        if (column < row)
          sub_triangles.push_back({corner + step * glm::dvec2(row - column, column + 1), -step});
      }
    }
    return sub_triangles;
  }
};

/// Emission of one triangle.
class EmissiveTriangle {
 public:
  EmissiveTriangle(const SceneData& scene, const Materials& materials, std::uint32_t triangle)
      : materials_(materials), index_(triangle) {
    const std::array<glm::dvec3, 3> corners = corners_of(scene, scene.triangles[triangle]);
    first_ = corners[0], to_second_ = corners[1] - first_, to_third_ = corners[2] - first_;
    normal_ = glm::cross(to_second_, to_third_);
  }

  EmittedPoint point(const SubTriangle& sub_triangle, double side) const {
    EmittedPoint point;
    const double twice_area = glm::length(normal_);
    if (twice_area == 0) return point;
    const glm::dvec2 w = sub_triangle.centroid();
    point.position = first_ + w.x * to_second_ + w.y * to_third_;
    point.normal = side / twice_area * normal_;
    const std::vector<SubTriangle> samples = sub_triangle.divided(CLPV_EMIT_SAMPLES);
    const double flux = std::numbers::pi * twice_area / 2 * sub_triangle.edge * sub_triangle.edge /
                        static_cast<double>(samples.size());
    for (const SubTriangle& sample : samples) {
      const glm::dvec3 emitted = flux * radiance(sample);
      const double solid = materials_.solidity({index_, glm::vec2(sample.centroid())});
      if (solid >= 0) point.flux += emitted;
      if (std::abs(solid) < kAlphaTolerance)
        point.tolerance += std::max({emitted.x, emitted.y, emitted.z});
    }
    return point;
  }

 private:
  /// Filtered radiance of a sample [W/m^2/sr].
  glm::dvec3 radiance(const SubTriangle& sample) const {
    const double width = double{CLPV_EMIT_FOOTPRINT} * sample.edge;
    return glm::dvec3(materials_.emissive({index_, glm::vec2(sample.centroid())},
                                          {width * to_second_, width * to_third_}));
  }

  const Materials& materials_;
  std::uint32_t index_;
  glm::dvec3 first_, to_second_, to_third_, normal_;
};

}  // namespace

std::vector<EmittedPoint> emit(const SceneData& scene, const EmissionPlan& plan) {
  const Materials materials(scene);
  std::vector<EmittedPoint> points;
  for (const ClpvEmitter& emitter : plan.parts) {
    const EmissiveTriangle triangle(scene, materials, emitter.triangle);
    const SubTriangle whole{{emitter.u, emitter.v}, emitter.size};
    for (const SubTriangle& sub_triangle : whole.divided(static_cast<int>(emitter.rows)))
      points.push_back(triangle.point(sub_triangle, double{emitter.side}));
  }
  return points;
}

}  // namespace clpv::reference
