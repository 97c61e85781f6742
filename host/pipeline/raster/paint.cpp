// SPDX-License-Identifier: MIT
#include "pipeline/raster/paint.hpp"

#include <limits>

#include "pipeline/raster/cells.hpp"
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
