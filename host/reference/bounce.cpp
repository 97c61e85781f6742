// SPDX-License-Identifier: MIT
#include "reference/bounce.hpp"

#include <algorithm>
#include <functional>
#include <glm/glm.hpp>

#include "basis/bounce.hpp"
#include "basis/sweep.hpp"

namespace clpv::reference {
namespace {

template <typename Visit>
void for_each_cell(int n, Visit visit) {
  for (int i = 0; i < n * n * n; ++i) visit(i % n, i / n % n, i / n / n);
}

/// Adds the light of surfaces on which `arriving(channel, cell)` falls, six fluxes.
void send_back(Volume& light, const Volume& reflectors,
               const std::function<std::vector<double>(int, const glm::ivec3&)>& arriving) {
  const Matrix leaving = leaving_light();
  for_each_cell(light.n, [&](int x, int y, int z) {
    for (int channel = 0; channel < 3; ++channel) {
      std::vector<double> flux = arriving(channel, {x, y, z});
      for (int side = 0; side < kReflectingSides; ++side)
        flux[static_cast<std::size_t>(side)] *= reflectors.value(channel, side, x, y, z);
      const std::vector<double> sent = leaving * std::span<const double>(flux);
      for (int bin = 0; bin < kSweepBins; ++bin)
        light.at(channel, bin, x, y, z) += sent[static_cast<std::size_t>(bin)];
    }
  });
}

/// What falls on each side of a cell, of what a sweep left.
std::vector<double> arriving_at(const Matrix& flux, const Volume& swept, int channel, const glm::ivec3& p) {
  std::vector<double> light(kSweepBins);
  for (int bin = 0; bin < kSweepBins; ++bin)
    light[static_cast<std::size_t>(bin)] = swept.value(channel, bin, p.x, p.y, p.z);
  return flux * std::span<const double>(light);
}

/// Injected light as its means over bins.
Volume in_bins(const Basis& basis, const Volume& injected) {
  const Matrix means = bin_means(basis);
  Volume light(injected.n, kSweepBins);
  std::vector<double> c(static_cast<std::size_t>(basis.size()));
  for_each_cell(light.n, [&](int x, int y, int z) {
    for (int channel = 0; channel < 3; ++channel) {
      for (int i = 0; i < basis.size(); ++i)
        c[static_cast<std::size_t>(i)] = injected.value(channel, i, x, y, z);
      const std::vector<double> in = means * std::span<const double>(c);
      for (int bin = 0; bin < kSweepBins; ++bin)
        light.at(channel, bin, x, y, z) = in[static_cast<std::size_t>(bin)];
    }
  });
  return light;
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
    for_each_cell(in_all.n, [&](int x, int y, int z) {
      for (int channel = 0; channel < 3; ++channel) {
        const std::vector<double> met = arriving_at(flux, swept[0], channel, {x, y, z});
        for (int side = 0; side < kReflectingSides; ++side) {
          in_all.at(channel, side, x, y, z) =
              reflectors.value(channel, side, x, y, z) * (1 + met[static_cast<std::size_t>(side)]);
        }
      }
    });
  }
  return in_all;
}

std::vector<Volume> bounce(const Basis& basis, const Transport& transport, std::vector<SweptCascade> cascades,
                           const std::vector<const Volume*>& reflectors, Bounces bounces) {
  for (SweptCascade& cascade : cascades) cascade.parts = 1;
  std::vector<Volume> light;
  for (const SweptCascade& cascade : cascades) light.push_back(in_bins(basis, *cascade.injected));
  if (bounces == Bounces::one) return light;
  const std::vector<Volume> swept = sweep(basis, transport, cascades);
  const Matrix flux = arriving_flux();
  for (std::size_t c = 0; c < cascades.size(); ++c) {
    const Volume reflecting =
        bounces == Bounces::all ? reflectors_in_all(transport, cascades[c], *reflectors[c]) : *reflectors[c];
    send_back(light[c], reflecting,
              [&](int channel, const glm::ivec3& p) { return arriving_at(flux, swept[c], channel, p); });
  }
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
