// SPDX-License-Identifier: MIT
#include "pipeline/raster/paint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/scene.hpp"

namespace clpv {

void paint_sky(const Sky& sky, const std::optional<ClpvMedium>& medium, const ClpvView& view,
               std::vector<float>& image) {
  const glm::dvec3 forward = vector(view.forward), right = vector(view.right), up = vector(view.up);
  for (unsigned y = 0; y < view.height; ++y) {
    for (unsigned x = 0; x < view.width; ++x) {
      float* pixel = &image[std::size_t{4} * (std::size_t{y} * view.width + x)];
      if (pixel[3] != 0) continue;
      glm::dvec3 ray = forward;
      if (view.orthographic == 0) {
        ray += (2 * (x + 0.5) / view.width - 1) * double{view.half_width} * right +
               (1 - 2 * (y + 0.5) / view.height) * double{view.half_height} * up;
      }
      const glm::dvec3 along = glm::normalize(ray);
      glm::dvec3 seen(sky.interpolated(along));
      if (medium) {
        const double far = std::numeric_limits<double>::infinity();
        seen *= transmittance(*medium, medium_part(*medium, vector(view.eye), along, far));
      }
      for (int channel = 0; channel < 3; ++channel)
        pixel[channel] += static_cast<float>(seen[channel]);
      pixel[3] = 1;
    }
  }
}

namespace {

constexpr double kNearest = 1.5;  // distance of the nearest sphere from the eye [cells]
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Ray in cells: from + t * along, t = 1 at depth 1 m.
struct CellRay {
  glm::dvec3 from, along;
};

/// Distance t of the first point of the ray on a sphere; nothing if it misses.
std::optional<double> hit(const CellRay& ray, const glm::dvec3& centre) {
  const glm::dvec3 off = ray.from - centre;
  const double a = glm::dot(ray.along, ray.along), b = glm::dot(ray.along, off),
               c = glm::dot(off, off) - kSphereRadius * kSphereRadius;
  const double discriminant = b * b - a * c;
  if (discriminant < 0 || c < 0) return std::nullopt;
  const double t = (-b - std::sqrt(discriminant)) / a;
  return t > 0 ? std::optional(t) : std::nullopt;
}

/// Walks through the cells of a grid in the order of the ray (Amanatides and Woo 1987) up to t =
/// `end`. Calls visit(cell) until it returns true.
template <typename Visit>
void walk(const CellRay& ray, int n, double end, const Visit& visit) {
  double enter = 0, leave = end;
  for (int i = 0; i < 3; ++i) {
    const double a = -ray.from[i] / ray.along[i], b = (n - ray.from[i]) / ray.along[i];
    if (ray.along[i] == 0) {
      if (ray.from[i] < 0 || ray.from[i] >= n) return;
      continue;
    }
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (!(enter < leave)) return;
  const glm::dvec3 start = ray.from + enter * ray.along;
  glm::ivec3 cell, step;
  glm::dvec3 next, delta;
  for (int i = 0; i < 3; ++i) {
    cell[i] = std::clamp(static_cast<int>(std::floor(start[i])), 0, n - 1);
    step[i] = ray.along[i] < 0 ? -1 : 1;
    next[i] =
        ray.along[i] == 0 ? kInfinity : (cell[i] + (step[i] > 0) - ray.from[i]) / ray.along[i];
    delta[i] = ray.along[i] == 0 ? kInfinity : std::abs(1 / ray.along[i]);
  }
  while (!visit(cell)) {
    int axis = next.x < next.y ? 0 : 1;
    if (next.z < next[axis]) axis = 2;
    if (next[axis] > leave) return;
    cell[axis] += step[axis];
    if (cell[axis] < 0 || cell[axis] >= n) return;
    next[axis] += delta[axis];
  }
}

}  // namespace

CellSpheres visible_spheres(const ClpvView& view, const std::vector<float>& depth,
                            const ClpvGrid& grid) {
  CellSpheres found;
  const double cell_edge = grid.cell;
  const glm::dvec3 origin = vector(grid.origin), eye = (vector(view.eye) - origin) / cell_edge;
  for (std::size_t pixel = 0; pixel < depth.size(); ++pixel) {
    const double sx = (2 * (pixel % view.width + 0.5) / view.width - 1) * double{view.half_width},
                 sy = (1 - 2 * (pixel / view.width + 0.5) / view.height) * double{view.half_height};
    const CellRay ray{
        eye, (vector(view.forward) + sx * vector(view.right) + sy * vector(view.up)) / cell_edge};
    const double end = depth[pixel] > 0 ? double{depth[pixel]} : kInfinity;
    walk(ray, static_cast<int>(grid.n), end, [&](const glm::ivec3& cell) {
      const glm::dvec3 centre = glm::dvec3(cell) + 0.5;
      if (glm::length(centre - eye) < kNearest) return false;
      const auto t = hit(ray, centre);
      if (!t || *t >= end) return false;
      found.pixels.push_back(pixel);
      found.centres.push_back(origin + cell_edge * centre);
      found.normals.push_back((ray.from + *t * ray.along - centre) / kSphereRadius);
      return true;
    });
  }
  return found;
}

void paint_cells(const ClpvGrid& grid, double gather_offset, const IrradianceAt& irradiance_at,
                 const ClpvView& view, const std::vector<float>& depth, std::vector<float>& image) {
  const CellSpheres spheres = visible_spheres(view, depth, grid);
  const double lift = gather_offset * double{grid.cell};
  std::vector<glm::vec4> positions, normals;
  for (std::size_t i = 0; i < spheres.pixels.size(); ++i) {
    positions.emplace_back(glm::vec3(spheres.centres[i] - lift * spheres.normals[i]), 0);
    normals.emplace_back(glm::vec3(spheres.normals[i]), 0);
  }
  const std::vector<glm::vec4> light = irradiance_at(std::move(positions), std::move(normals));
  for (std::size_t i = 0; i < light.size(); ++i) {
    float* pixel = &image[4 * spheres.pixels[i]];
    for (int channel = 0; channel < 3; ++channel) pixel[channel] = light[i][channel];
    pixel[3] = 1;
  }
}

}  // namespace clpv
