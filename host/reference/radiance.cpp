// SPDX-License-Identifier: MIT
#include "reference/radiance.hpp"

#include "reference/cascade_sample.hpp"

namespace clpv::reference {

RadianceField radiance_field(const GatherOptions& options, const std::vector<Cascade>& cascades,
                             int coefficients, const glm::dvec3& position, double offset,
                             const glm::dvec3& lift) {
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
      apply_visibility(sample, at, options.grid, cascade.occluded);
    const double weight = share * rest / (double{grid.cell} * grid.cell);
    for (int channel = 0; channel < 3 && weight > 0; ++channel) {
      const std::vector<double> c = interpolated(*cascade.accumulated, channel, sample);
      for (int i = 0; i < coefficients; ++i) field[channel][i] += weight * c[i];
    }
    rest *= 1 - share;
  }
  return field;
}

glm::dvec3 radiance(const Basis& basis, const RadianceField& field, const glm::dvec3& w) {
  std::vector<double> y(static_cast<std::size_t>(basis.size()));
  basis.evaluate(w, y);
  return {dot(y, field[0]), dot(y, field[1]), dot(y, field[2])};
}

glm::dvec3 field_irradiance(const Basis& basis, const RadianceField& field,
                            const glm::dvec3& normal) {
  std::vector<double> alpha(static_cast<std::size_t>(basis.size()));
  basis.cosine_integrals(-normal, alpha);
  return glm::max(glm::dvec3(dot(alpha, field[0]), dot(alpha, field[1]), dot(alpha, field[2])),
                  0.0);
}

}  // namespace clpv::reference
