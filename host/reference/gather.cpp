// SPDX-License-Identifier: MIT
// E = 4 I(-n) / s^2 for face transports, E = alpha(-n) . c / s^2 for the sweep; c interpolated
// trilinearly at p + h s n_g. Swept E is divided by that of the white furnace, over pi.
#include "reference/gather.hpp"

#include <algorithm>
#include <numbers>

#include "basis/bounce.hpp"
#include "reference/cascade_sample.hpp"
#include "reference/view.hpp"

namespace clpv::reference {
namespace {

/// Weights g(n) of the coefficients: E s^2 = g(n) . c.
std::vector<double> gather_weights(const Basis& basis, TransportKind transport,
                                   const LobeOptions& lobes, const glm::dvec3& normal) {
  std::vector<double> weights(static_cast<std::size_t>(basis.size()));
  if (!has_faces(transport)) {
    basis.cosine_integrals(-normal, weights);
    return weights;
  }
  weights = evaluate(basis, lobes, -normal);
  for (double& weight : weights) weight *= 4;
  return weights;
}

/// E s^2 from one volume, clamped at 0; of swept light also E of the furnace.
glm::dvec4 irradiance(const Volume& volume, const TrilinearSample& sample,
                      const std::vector<double>& weights) {
  glm::dvec4 e(0);
  for (int channel = 0; channel < volume.channels; ++channel)
    e[channel] = std::max(0.0, dot(weights, interpolated(volume, channel, sample)));
  return e;
}

}  // namespace

glm::dvec3 gather(const Basis& basis, TransportKind transport, const GatherOptions& options,
                  const std::vector<Cascade>& cascades, const glm::dvec3& position,
                  const glm::dvec3& normal, const glm::dvec3& lift, const ClearWay& clear) {
  const std::vector<double> weights = gather_weights(basis, transport, options.lobes, normal);
  glm::dvec4 e(0);
  double rest = 1;  // weight of the coarser cascades
  for (const Cascade& cascade : cascades) {
    const ClpvGrid& grid = cascade.grid;
    const glm::dvec3 at = (position - vector(grid.origin)) / double{grid.cell};
    const double share = share_of(position, grid, options.grid, options.blend_cells);
    // The first cell's centre is at 0.5.
    const glm::dvec3 point = at + options.gather_offset * lift - 0.5;
    const double area = double{grid.cell} * grid.cell;
    const TrilinearSample sample = sample_of(options, cascade, point, clear);
    e += share * rest / glm::dvec4(area, area, area, 1) *
         irradiance(*cascade.accumulated, sample, weights);
    rest *= 1 - share;
  }
  if (has_faces(transport)) return glm::dvec3(e);
  return glm::dvec3(e) / over_furnace(e.w / std::numbers::pi + rest);
}

bool rounding_decides(const GatherOptions& options, const std::vector<Cascade>& cascades,
                      const glm::dvec3& position, double offset, const glm::dvec3& lift,
                      const ClearWay& clear) {
  return options.gather == Gathering::visible &&
         std::ranges::any_of(cascades, [&](const Cascade& cascade) {
           const glm::dvec3 at =
               (position - vector(cascade.grid.origin)) / double{cascade.grid.cell};
           return rounding_decides(at + offset * lift - 0.5, clear, cascade.grid.cell,
                                   options.grid);
         });
}

std::vector<glm::dvec3> gather(const Basis& basis, TransportKind transport,
                               const GatherOptions& options, const std::vector<Cascade>& cascades,
                               const SurfaceImage& camera, std::size_t every) {
  std::vector<glm::dvec3> image;
  for (std::size_t pixel = 0; pixel < camera.depth.size(); pixel += every) {
    glm::dvec3& irradiance = image.emplace_back(0);
    const double depth = camera.depth[pixel];
    if (depth <= 0) continue;
    const glm::dvec3 position = surface_position(camera.view, pixel, depth);
    irradiance =
        gather(basis, transport, options, cascades, position, glm::dvec3(camera.normal[pixel]),
               lift_normal(camera.normal[pixel]), towards_eye(camera.view, position));
  }
  return image;
}

}  // namespace clpv::reference
