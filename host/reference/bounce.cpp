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
  const Matrix leaving = leaving_light();
  for_each_cell(light.n, [&](const glm::ivec3& p) {
    for (int channel = 0; channel < 3; ++channel) {
      std::vector<double> flux = arriving(channel, p);
      for (int side = 0; side < kReflectingSides; ++side)
        flux[side] *= reflectors.value(channel, side, p.x, p.y, p.z);
      const std::vector<double> sent = leaving * std::span<const double>(flux);
      for (int bin = 0; bin < kSweepBins; ++bin) light.at(channel, bin, p.x, p.y, p.z) += sent[bin];
    }
  });
}

/// What falls on each side of a cell, of what a sweep left.
std::vector<double> arriving_at(const Matrix& flux, const Volume& swept, int channel, const glm::ivec3& p) {
  std::vector<double> light(kSweepBins);
  for (int bin = 0; bin < kSweepBins; ++bin) light[bin] = swept.value(channel, bin, p.x, p.y, p.z);
  return flux * std::span<const double>(light);
}

/// Injected light as its means over bins.
Volume in_bins(const Basis& basis, const Volume& injected) {
  const Matrix means = bin_means(basis);
  Volume light(injected.n, kSweepBins);
  std::vector<double> c(basis.size());
  for_each_cell(light.n, [&](const glm::ivec3& p) {
    for (int channel = 0; channel < 3; ++channel) {
      for (int i = 0; i < basis.size(); ++i) c[i] = injected.value(channel, i, p.x, p.y, p.z);
      const std::vector<double> in = means * std::span<const double>(c);
      for (int bin = 0; bin < kSweepBins; ++bin) light.at(channel, bin, p.x, p.y, p.z) = in[bin];
    }
  });
  return light;
}

/// Of 24 bins.
Volume swept_along_24(const Transport& transport, SweptCascade cascade, const Volume& light) {
  cascade.injected = &light, cascade.parts = 1;
  return sweep(*make_basis("bins24"), transport, {cascade})[0];
}

Arriving arriving_of(const Volume& swept) {
  return [flux = arriving_flux(), &swept](int channel, const glm::ivec3& p) {
    return arriving_at(flux, swept, channel, p);
  };
}

/// On a finer cascade's cells, of what a sweep left in a coarser one: trilinear between cells' centres, nothing beyond it.
std::vector<double> arriving_from(const ClpvGrid& coarse, const Volume& swept, const ClpvGrid& fine,
                                  int channel, const glm::ivec3& p) {
  static const Matrix flux = arriving_flux();
  glm::dvec3 at;
  for (int axis = 0; axis < 3; ++axis)
    at[axis] =
        (fine.origin[axis] + double{fine.cell} * (p[axis] + 0.5) - coarse.origin[axis]) / coarse.cell - 0.5;
  const glm::dvec3 low = glm::floor(at), t = at - low;
  std::vector<double> sum(kReflectingSides, 0.0);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 up(corner & 1, corner >> 1 & 1, corner >> 2), cell = glm::ivec3(low) + up;
    if (!swept.inside(cell.x, cell.y, cell.z)) continue;
    const glm::dvec3 weights = glm::mix(1.0 - t, t, glm::dvec3(up));
    const std::vector<double> there = arriving_at(flux, swept, channel, cell);
    for (std::size_t side = 0; side < sum.size(); ++side)
      sum[side] += weights.x * weights.y * weights.z * there[side];
  }
  const double area = double{fine.cell} * fine.cell / (double{coarse.cell} * coarse.cell);
  for (double& value : sum) value *= area;
  return sum;
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
    send_back(light[c], *reflectors[c], [&](int channel, const glm::ivec3& p) {
      return arriving_from(cascades[c + 1].grid, swept, cascades[c].grid, channel, p);
    });
  }
}

}  // namespace

Volume reflectors_in_all(const Transport& transport, const SweptCascade& cascade, const Volume& reflectors) {
  const auto bins = make_basis("bins24");
  const Matrix flux = arriving_flux();
  Volume in_all = reflectors;
  for (int bounce = 0; bounce < kFurtherBounces; ++bounce) {
    Volume sent(static_cast<int>(cascade.grid.n), kSweepBins);
    send_back(sent, in_all,
              [](int, const glm::ivec3&) { return std::vector<double>(kReflectingSides, 1.0); });
    const std::vector<Volume> swept = sweep(*bins, transport, {{cascade.grid, &sent, cascade.geometry, 1}});
    for_each_cell(in_all.n, [&](const glm::ivec3& p) {
      for (int channel = 0; channel < 3; ++channel) {
        const std::vector<double> met = arriving_at(flux, swept[0], channel, p);
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
