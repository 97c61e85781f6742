// SPDX-License-Identifier: MIT
// F = max(0, Omega_f I(w_f)) T_f; the destination gains c += (F / pi) c(n_f).
#include "reference/propagate.hpp"

#include <algorithm>
#include <span>
#include <vector>

#include "reference/transmittance.hpp"

namespace clpv::reference {
namespace {

int column_of(const glm::ivec3& normal) {
  return std::find(kAxes.begin(), kAxes.end(), normal) - kAxes.begin();
}

/// One number per cell, in the order of Volume::values.
using CellValues = std::vector<double>;

/// Transmittance of one link into every cell.
CellValues cell_transmittances(const Volume& geometry, const glm::ivec3& side,
                               const std::vector<double>& weights) {
  CellValues result;
  for_each_cell(geometry.n - 1, [&](const glm::ivec3& p) {
    result.push_back(transmittance(geometry, p, side, weights));
  });
  return result;
}

const FaceTransport& faces_of(const Transport& transport) {
  return std::get<FaceTransport>(transport.scheme);
}

/// Transmittances of all links; empty without blockers.
std::vector<CellValues> link_transmittances(const Transport& transport, const Volume* geometry) {
  std::vector<CellValues> links;
  if (geometry == nullptr) return links;
  for (const Face& face : faces_of(transport).faces)
    links.push_back(cell_transmittances(*geometry, face.normal, face.blocked_by));
  return links;
}

/// sum_i weights[i] c_i of the cell at -`travel` from each cell; 0 outside the grid.
CellValues upstream_sum(const Volume& from, int channel, const glm::ivec3& travel,
                        std::span<const double> weights) {
  const int n = from.n, first = std::max(0, travel.x), last = n + std::min(0, travel.x);
  CellValues sum(static_cast<std::size_t>(n) * n * n, 0.0);
  for (int i = 0; i < from.coefficients; ++i) {
    const double weight = weights[i];
    if (weight == 0) continue;
    for (int z = std::max(0, travel.z); z < n + std::min(0, travel.z); ++z) {
      for (int y = std::max(0, travel.y); y < n + std::min(0, travel.y); ++y) {
        double* to = sum.data() + (static_cast<std::size_t>(z) * n + y) * n;
        const double* c =
            from.values.data() + from.index(channel, i, 0, y - travel.y, z - travel.z);
        for (int x = first; x < last; ++x) to[x] += weight * c[x - travel.x];
      }
    }
  }
  return sum;
}

void add(const CellValues& light, double factor, int channel, int i, Volume& to) {
  double* c = to.values.data() + to.index(channel, i, 0, 0, 0);
  for (std::size_t at = 0; at < light.size(); ++at) c[at] += factor * light[at];
}

void attenuate(CellValues& light, const std::vector<CellValues>& links, std::size_t link) {
  if (links.empty()) return;
  for (std::size_t at = 0; at < light.size(); ++at) light[at] *= links[link][at];
}

void add_faces(const FaceTransport& scheme, const Volume& from,
               const std::vector<CellValues>& links, int channel, Volume& to) {
  for (std::size_t w = 0; w < scheme.faces.size(); ++w) {
    const Face& face = scheme.faces[w];
    CellValues flux = upstream_sum(from, channel, face.travel, face.flux);
    for (double& value : flux) value = std::max(0.0, value);
    attenuate(flux, links, w);
    for (int i = 0; i < from.coefficients; ++i)
      add(flux, scheme.lobes(i, column_of(face.normal)), channel, i, to);
  }
}

Volume step(const Transport& transport, const Volume& travelling,
            const std::vector<CellValues>& links) {
  Volume next(travelling.n, travelling.coefficients, travelling.channels);
  for (int channel = 0; channel < next.channels; ++channel)
    add_faces(faces_of(transport), travelling, links, channel, next);
  return next;
}

}  // namespace

Volume propagate_step(const Transport& transport, const Volume& travelling,
                      const Volume* geometry) {
  return step(transport, travelling, link_transmittances(transport, geometry));
}

Propagation propagate(const Transport& transport, const Volume& injected, const Volume* geometry,
                      int iterations) {
  const std::vector<CellValues> links = link_transmittances(transport, geometry);
  Propagation result{injected, injected};
  for (int t = 1; t <= iterations; ++t) {
    result.travelling =
        step(transport, result.travelling, t > 1 ? links : std::vector<CellValues>());
    for (std::size_t i = 0; i < result.accumulated.values.size(); ++i) {
      result.accumulated.values[i] += result.travelling.values[i];
    }
  }
  return result;
}

std::array<double, 3> energy(const Basis& basis, const Volume& volume) {
  std::array<double, 3> sum{};
  for (int channel = 0; channel < volume.channels; ++channel) {
    for_each_cell(volume.n, [&](const glm::ivec3& p) {
      sum[channel] += basis.energy(volume.cell(channel, p));
    });
  }
  return sum;
}

}  // namespace clpv::reference
