// SPDX-License-Identifier: MIT
#include "reference/bounce.hpp"

#include <algorithm>
#include <functional>
#include <glm/glm.hpp>

#include "basis/bounce.hpp"
#include "basis/sweep.hpp"

namespace clpv::reference {
namespace {

/// Six fluxes that fall on a cell's sides, of a channel.
using Arriving = std::function<std::vector<double>(int, const glm::ivec3&)>;

/// Adds the light of surfaces on which that falls.
void send_back(Volume& light, const Volume& reflectors, const Arriving& arriving) {
  const Matrix leaving = reflected_intensity();
  for_each_cell(light.n, [&](const glm::ivec3& p) {
    for (int channel = 0; channel < 3; ++channel) {
      std::vector<double> flux = arriving(channel, p);
      for (int side = 0; side < kReflectingSides; ++side)
        flux[side] *= reflectors.value(channel, side, p.x, p.y, p.z);
      const std::vector<double> sent = leaving * flux;
      for (int bin = 0; bin < kSweepBins; ++bin) light.at(channel, bin, p.x, p.y, p.z) += sent[bin];
    }
  });
}

/// Of 24 bins.
Volume swept_along_24(const Transport& transport, SweptCascade cascade, const Volume& light) {
  cascade.injected = &light, cascade.parts = 1;
  return sweep(*make_basis("bins24"), transport, {cascade})[0];
}

/// What falls on each side of a cell, of what a sweep left.
Arriving arriving_of(const Volume& swept) {
  return [flux = incident_flux(), &swept](int channel, const glm::ivec3& p) {
    return flux * swept.cell(channel, p);
  };
}

/// On a finer cascade's cells, of what a sweep left in a coarser one.
Arriving arriving_from(const ClpvGrid& coarse, const Volume& swept, const ClpvGrid& fine) {
  const double area = double{fine.cell} * fine.cell / (double{coarse.cell} * coarse.cell);
  return [=, flux = incident_flux(), &swept](int channel, const glm::ivec3& p) {
    std::vector<double> sum = flux * sampled(swept, channel, place_in(coarse, fine, p));
    for (double& value : sum) value *= area;
    return sum;
  };
}

/// Each cascade by itself and what comes in at its border, along 24 directions.
void bounce_once(const Transport& transport, std::vector<SweptCascade> cascades,
                 const std::vector<const Volume*>& reflectors, std::vector<Volume>& light) {
  for (SweptCascade& cascade : cascades) cascade.parts = 1;
  const std::vector<Volume> swept = sweep(*make_basis("bins24"), transport, cascades);
  for (std::size_t c = 0; c < cascades.size(); ++c)
    send_back(light[c], *reflectors[c], arriving_of(swept[c]));
}

/// The coarsest cascade twice, the second time all that follows; finer ones what falls on them in the next coarser one.
void bounce_in_all(const Transport& transport, const std::vector<SweptCascade>& cascades,
                   const std::vector<const Volume*>& reflectors, std::vector<Volume>& light) {
  const SweptCascade& coarsest = cascades.back();
  const Volume first = swept_along_24(transport, coarsest, light.back());
  Volume sent(first.n, kSweepBins);
  send_back(sent, *reflectors.back(), arriving_of(first));
  send_back(light.back(), *reflectors.back(), arriving_of(first));
  const Volume second = swept_along_24(transport, coarsest, sent);
  send_back(light.back(), reflectors_in_all(transport, coarsest, *reflectors.back()), arriving_of(second));
  for (std::size_t c = cascades.size() - 1; c-- > 0;) {
    const std::vector<SweptCascade> beyond(cascades.begin() + static_cast<std::ptrdiff_t>(c) + 1,
                                           cascades.end());
    const Volume swept = sweep(*make_basis("bins24"), transport, beyond)[0];
    send_back(light[c], *reflectors[c], arriving_from(cascades[c + 1].grid, swept, cascades[c].grid));
  }
}

}  // namespace

Volume reflectors_in_all(const Transport& transport, const SweptCascade& cascade, const Volume& reflectors) {
  Volume in_all = reflectors;
  for (int bounce = 0; bounce < kFurtherBounces; ++bounce) {
    Volume sent(in_all.n, kSweepBins);
    send_back(sent, in_all,
              [](int, const glm::ivec3&) { return std::vector<double>(kReflectingSides, 1.0); });
    const Volume swept = swept_along_24(transport, cascade, sent);
    const Arriving arriving = arriving_of(swept);
    for_each_cell(in_all.n, [&](const glm::ivec3& p) {
      for (int channel = 0; channel < 3; ++channel) {
        const std::vector<double> met = arriving(channel, p);
        for (int side = 0; side < kReflectingSides; ++side) {
          in_all.at(channel, side, p.x, p.y, p.z) =
              reflectors.value(channel, side, p.x, p.y, p.z) * (1 + met[side]);
        }
      }
    });
  }
  return in_all;
}

std::vector<Volume> bounce(const Basis& basis, const Transport& transport, std::vector<SweptCascade> cascades,
                           const std::vector<const Volume*>& reflectors, Bounces bounces) {
  std::vector<Volume> light;
  for (const SweptCascade& cascade : cascades) light.push_back(in_bins(basis, *cascade.injected));
  for (std::size_t c = 0; c < cascades.size(); ++c) cascades[c].injected = &light[c];
  if (bounces == Bounces::two) bounce_once(transport, cascades, reflectors, light);
  if (bounces == Bounces::all) bounce_in_all(transport, cascades, reflectors, light);
  return light;
}

std::vector<Volume> sweep_bounced(const Basis& basis, const Transport& transport,
                                  std::vector<SweptCascade> cascades,
                                  const std::vector<const Volume*>& reflectors, Bounces bounces) {
  const auto bins = make_basis("bins24");
  const std::vector<Volume> light = bounce(basis, transport, cascades, reflectors, bounces);
  for (std::size_t c = 0; c < cascades.size(); ++c) cascades[c].injected = &light[c];
  return sweep(*bins, transport, cascades);
}

}  // namespace clpv::reference
