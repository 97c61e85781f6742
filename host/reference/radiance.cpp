// SPDX-License-Identifier: MIT
#include "reference/radiance.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "basis/bounce.hpp"
#include "reference/cascade_sample.hpp"

namespace clpv::reference {

RadianceField radiance_field(const GatherOptions& options, const std::vector<Cascade>& cascades,
                             int coefficients, const glm::dvec3& position, double offset,
                             const glm::dvec3& lift, const glm::dvec3& clear) {
  RadianceField field;
  for (auto& channel : field) channel.assign(coefficients, 0.0);
  double rest = 1;  // weight of the coarser cascades
  for (const Cascade& cascade : cascades) {
    const ClpvGrid& grid = cascade.grid;
    const double share = share_of(position, grid, options.grid, options.blend_cells);
    const glm::dvec3 at =
        (position - vector(grid.origin)) / double{grid.cell} + offset * lift - 0.5;
    TrilinearSample sample = trilinear_sample(at, options.grid);
    if (options.gather == Gathering::visible)
      apply_visibility(sample, at, clear, options.grid, cascade.occluded);
    for (int channel = 0; channel < 4 && share * rest > 0; ++channel) {
      const double weight = share * rest / (channel < 3 ? double{grid.cell} * grid.cell : 1);
      const std::vector<double> c = interpolated(*cascade.accumulated, channel, sample);
      for (int i = 0; i < coefficients; ++i) field[channel][i] += weight * c[i];
    }
    rest *= 1 - share;
  }
  field[3][0] += rest * 2 * std::sqrt(std::numbers::pi);
  return field;
}

namespace {

glm::dvec4 weighed(const std::vector<double>& weights, const RadianceField& field) {
  return {dot(weights, field[0]), dot(weights, field[1]), dot(weights, field[2]),
          dot(weights, field[3])};
}

}  // namespace

glm::dvec3 radiance(const Basis& basis, const RadianceField& field, const glm::dvec3& w) {
  std::vector<double> y(static_cast<std::size_t>(basis.size()));
  basis.evaluate(w, y);
  const glm::dvec4 light = weighed(y, field);
  return glm::dvec3(light) / over_furnace(light.w);
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
