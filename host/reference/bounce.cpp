// SPDX-License-Identifier: MIT
// One bounce: Phi_a = R_a sum_b Omega_b max(0, -w_b . a) L_b s^2, emitted by the cosine about a.
// All bounces without a medium: light = I + R D_1 + R (1 + E) D_2, a truncated Neumann series in
// the coarsest cascade.
#include "reference/bounce.hpp"

#include <algorithm>
#include <functional>
#include <glm/glm.hpp>

#include "basis/bounce.hpp"
#include "basis/sweep.hpp"
#include "reference/medium.hpp"

namespace clpv::reference {
namespace {

/// Incident flux [W] on the six faces of a cell, in a channel.
using IncidentFlux = std::function<std::vector<double>(int, const glm::ivec3&)>;

/// light += R D: adds the intensity of the reflected flux.
void inject_reflected(const Basis& basis, const Volume& reflectors, const IncidentFlux& incident,
                      Volume& light) {
  const Matrix intensity = reflected_intensity(basis);
  for_each_cell(light.n, [&](const glm::ivec3& p) {
    for (int channel = 0; channel < 3; ++channel) {
      std::vector<double> flux = incident(channel, p);
      for (int side = 0; side < kCellFaces; ++side)
        flux[side] *= reflectors.value(channel, side, p.x, p.y, p.z);
      const std::vector<double> added = intensity * flux;
      for (int i = 0; i < basis.size(); ++i) light.at(channel, i, p.x, p.y, p.z) += added[i];
    }
  });
}

/// Sweeps light along 24 directions.
Volume swept_along_24(const Basis& basis, const Transport& transport, SweptCascade cascade,
                      const Volume& light) {
  cascade.injected = &light, cascade.parts = 1;
  return sweep(basis, transport, {cascade})[0];
}

/// Incident flux of swept light.
IncidentFlux incident_flux_of(const Volume& swept) {
  return [flux = incident_flux(), &swept](int channel, const glm::ivec3& p) {
    return flux * swept.cell(channel, p);
  };
}

/// Incident flux on the cells of a finer cascade, interpolated from light swept in a coarser one.
IncidentFlux interpolated_flux(const ClpvGrid& coarse, const Volume& swept, const ClpvGrid& fine) {
  const double area = double{fine.cell} * fine.cell / (double{coarse.cell} * coarse.cell);
  return [=, flux = incident_flux(), &swept](int channel, const glm::ivec3& p) {
    std::vector<double> sum = flux * trilinear(swept, channel, position_in(coarse, fine, p));
    for (double& value : sum) value *= area;
    return sum;
  };
}

/// light += R D in every cascade.
void add_one_bounce(const Basis& basis, const Transport& transport,
                    std::vector<SweptCascade> cascades,
                    const std::vector<const Volume*>& reflectors, std::vector<Volume>& light) {
  for (SweptCascade& cascade : cascades) cascade.parts = 1;
  const std::vector<Volume> swept = sweep(basis, transport, cascades);
  for (std::size_t c = 0; c < cascades.size(); ++c)
    inject_reflected(basis, *reflectors[c], incident_flux_of(swept[c]), light[c]);
}

/// light += R D_1 + R (1 + E) D_2 in the coarsest cascade, R D in finer ones, D interpolated from
/// the next coarser one.
void add_all_bounces(const Basis& basis, const Transport& transport,
                     const std::vector<SweptCascade>& cascades,
                     const std::vector<const Volume*>& reflectors, std::vector<Volume>& light) {
  const SweptCascade& coarsest = cascades.back();
  const Volume first = swept_along_24(basis, transport, coarsest, light.back());
  Volume reflected(first.n, basis.size());
  inject_reflected(basis, *reflectors.back(), incident_flux_of(first), reflected);
  inject_reflected(basis, *reflectors.back(), incident_flux_of(first), light.back());
  const Volume second = swept_along_24(basis, transport, coarsest, reflected);
  inject_reflected(basis, bounce_series(basis, transport, coarsest, *reflectors.back()),
                   incident_flux_of(second), light.back());
  for (std::size_t c = cascades.size() - 1; c-- > 0;) {
    const std::vector<SweptCascade> coarser(cascades.begin() + static_cast<std::ptrdiff_t>(c) + 1,
                                            cascades.end());
    const Volume swept = sweep(basis, transport, coarser)[0];
    inject_reflected(basis, *reflectors[c],
                     interpolated_flux(cascades[c + 1].grid, swept, cascades[c].grid), light[c]);
  }
}

/// Light that sweeps start from, by cascade.
struct Sources {
  std::vector<Volume> light, scattered;

  /// Cascades from `first` on with these sources.
  std::vector<SweptCascade> of(std::vector<SweptCascade> cascades, std::size_t first) const {
    for (std::size_t c = 0; c < cascades.size(); ++c)
      cascades[c].injected = &light[c], cascades[c].scattered = &scattered[c];
    return {cascades.begin() + static_cast<std::ptrdiff_t>(first), cascades.end()};
  }
};

/// Bounces off surfaces and in a medium: each of `sweeps` sweeps along 24 directions is reflected
/// and scattered. A cascade's border has light of the coarser one's last sweep.
Sources bounce_in_medium(const Basis& basis, const Transport& transport,
                         const std::vector<SweptCascade>& cascades,
                         const std::vector<const Volume*>& reflectors, int sweeps) {
  Sources swept;  // sources of the last sweep
  for (const SweptCascade& cascade : cascades) {
    swept.light.push_back(*cascade.injected);
    swept.scattered.push_back(*cascade.scattered);
  }
  Sources result = swept;
  std::vector<SweptCascade> along_24 = cascades;
  for (SweptCascade& cascade : along_24) cascade.parts = 1;
  for (std::size_t c = cascades.size(); c-- > 0;) {
    for (int i = 0; i < sweeps; ++i) {
      swept.light[c] = result.light[c], swept.scattered[c] = result.scattered[c];
      const Volume found = sweep(basis, transport, swept.of(along_24, c))[0];
      result.light[c] = *cascades[c].injected;
      inject_reflected(basis, *reflectors[c], incident_flux_of(found), result.light[c]);
      result.scattered[c] = *cascades[c].scattered;
      add_scattered(*cascades[c].medium, found, result.scattered[c]);
    }
  }
  return result;
}

}  // namespace

Volume bounce_series(const Basis& basis, const Transport& transport, const SweptCascade& cascade,
                     const Volume& reflectors) {
  Volume series = reflectors;
  for (int bounce = 0; bounce < kFurtherBounces; ++bounce) {
    Volume reflected(series.n, basis.size());
    inject_reflected(
        basis, series, [](int, const glm::ivec3&) { return std::vector<double>(kCellFaces, 1.0); },
        reflected);
    const Volume swept = swept_along_24(basis, transport, cascade, reflected);
    const IncidentFlux incident = incident_flux_of(swept);
    for_each_cell(series.n, [&](const glm::ivec3& p) {
      for (int channel = 0; channel < 3; ++channel) {
        const std::vector<double> returned = incident(channel, p);
        for (int side = 0; side < kCellFaces; ++side) {
          series.at(channel, side, p.x, p.y, p.z) =
              reflectors.value(channel, side, p.x, p.y, p.z) * (1 + returned[side]);
        }
      }
    });
  }
  return series;
}

std::vector<Volume> bounce(const Basis& basis, const Transport& transport,
                           std::vector<SweptCascade> cascades,
                           const std::vector<const Volume*>& reflectors, Bounces bounces) {
  std::vector<Volume> light;
  for (const SweptCascade& cascade : cascades) light.push_back(*cascade.injected);
  for (std::size_t c = 0; c < cascades.size(); ++c) cascades[c].injected = &light[c];
  if (bounces == Bounces::two) add_one_bounce(basis, transport, cascades, reflectors, light);
  if (bounces == Bounces::all) add_all_bounces(basis, transport, cascades, reflectors, light);
  return light;
}

std::vector<Volume> sweep_bounced(const Basis& basis, const Transport& transport,
                                  std::vector<SweptCascade> cascades,
                                  const std::vector<const Volume*>& reflectors, Bounces bounces) {
  if (cascades.front().scattered != nullptr) {
    const Sources sources = bounce_in_medium(basis, transport, cascades, reflectors,
                                             bounces == Bounces::all ? kFurtherBounces + 2 : 1);
    return sweep(basis, transport, sources.of(cascades, 0));
  }
  const std::vector<Volume> light = bounce(basis, transport, cascades, reflectors, bounces);
  for (std::size_t c = 0; c < cascades.size(); ++c) cascades[c].injected = &light[c];
  return sweep(basis, transport, cascades);
}

}  // namespace clpv::reference
