// SPDX-License-Identifier: MIT
#include "reference/propagate.hpp"

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "reference/transmit.hpp"

namespace clpv::reference {
namespace {

std::vector<double> cell(const Volume& volume, int channel, const glm::ivec3& p) {
  std::vector<double> c(volume.coefficients);
  for (int i = 0; i < volume.coefficients; ++i) c[i] = volume.value(channel, i, p.x, p.y, p.z);
  return c;
}

double flux_through(const Face& face, const std::vector<double>& c, bool clamp) {
  double flux = 0;
  for (std::size_t i = 0; i < c.size(); ++i) flux += face.flux[i] * c[i];
  return clamp ? std::max(0.0, flux) : flux;
}

int column_of(const glm::ivec3& normal) {
  return static_cast<int>(std::find(kAxes.begin(), kAxes.end(), normal) - kAxes.begin());
}

template <typename Visit>
void for_each_cell(int n, Visit visit) {
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) visit(glm::ivec3(x, y, z));
    }
  }
}

/// One number a cell, in the order of Volume::values.
using Plane = std::vector<double>;

/// 1 - B of every cell on one way into it.
Plane transmittances(const Volume& geometry, const glm::ivec3& side, const std::vector<double>& weights) {
  Plane open;
  for_each_cell(geometry.n - 1,
                [&](const glm::ivec3& p) { open.push_back(transmitted(geometry, p, side, weights)); });
  return open;
}

/// The ways into a cell, each with what it lets through: `shares` is empty where nothing blocks, `shares[w]` where nothing
/// blocks on that way.
std::vector<Plane> shares_of(const Transport& transport, const Volume* geometry) {
  std::vector<Plane> shares;
  if (geometry == nullptr) return shares;
  if (const auto* faces = std::get_if<FaceTransport>(&transport.scheme)) {
    for (const Face& face : faces->faces)
      shares.push_back(transmittances(*geometry, face.normal, face.blocked_by));
    return shares;
  }
  for (const auto& neighbour : std::get<OperatorTransport>(transport.scheme).neighbours) {
    const bool blocks = neighbour.offset != glm::ivec3(0);
    shares.push_back(blocks ? transmittances(*geometry, -neighbour.offset, neighbour.blocked_by) : Plane());
  }
  return shares;
}

/// sum_i weights[i] c_i of the cell that lies `travel` upstream of each one; 0 from outside.
Plane arriving(const Volume& from, int channel, const glm::ivec3& travel, std::span<const double> weights) {
  const int n = from.n, first = std::max(0, travel.x), last = n + std::min(0, travel.x);
  Plane sum(static_cast<std::size_t>(n) * n * n, 0.0);
  for (int i = 0; i < from.coefficients; ++i) {
    const double weight = weights[i];
    if (weight == 0) continue;
    for (int z = std::max(0, travel.z); z < n + std::min(0, travel.z); ++z) {
      for (int y = std::max(0, travel.y); y < n + std::min(0, travel.y); ++y) {
        double* to = sum.data() + (static_cast<std::size_t>(z) * n + y) * n;
        const double* c = from.values.data() + from.index(channel, i, 0, y - travel.y, z - travel.z);
        for (int x = first; x < last; ++x) to[x] += weight * c[x - travel.x];
      }
    }
  }
  return sum;
}

void add(const Plane& light, double factor, int channel, int i, Volume& to) {
  double* c = to.values.data() + to.index(channel, i, 0, 0, 0);
  for (std::size_t at = 0; at < light.size(); ++at) c[at] += factor * light[at];
}

void block(Plane& light, const std::vector<Plane>& shares, std::size_t way) {
  if (shares.empty() || shares[way].empty()) return;
  for (std::size_t at = 0; at < light.size(); ++at) light[at] *= shares[way][at];
}

void add_faces(const FaceTransport& scheme, const Volume& from, const std::vector<Plane>& shares, bool clamp,
               int channel, Volume& to) {
  for (std::size_t w = 0; w < scheme.faces.size(); ++w) {
    const Face& face = scheme.faces[w];
    Plane flux = arriving(from, channel, face.travel, face.flux);
    if (clamp) {
      for (double& value : flux) value = std::max(0.0, value);
    }
    block(flux, shares, w);
    for (int i = 0; i < from.coefficients; ++i)
      add(flux, scheme.lobes(i, column_of(face.normal)), channel, i, to);
  }
}

void add_operators(const OperatorTransport& scheme, const Volume& from, const std::vector<Plane>& shares,
                   int channel, Volume& to) {
  for (std::size_t w = 0; w < scheme.neighbours.size(); ++w) {
    const OperatorTransport::Neighbour& neighbour = scheme.neighbours[w];
    for (int i = 0; i < from.coefficients; ++i) {
      Plane arrived = arriving(from, channel, neighbour.offset, neighbour.weights.row(i));
      block(arrived, shares, w);
      add(arrived, 1, channel, i, to);
    }
  }
}

Volume step(const Transport& transport, const Volume& travelling, const std::vector<Plane>& shares,
            bool clamp) {
  Volume next(travelling.n, travelling.coefficients, travelling.channels);
  for (int channel = 0; channel < next.channels; ++channel) {
    if (const auto* faces = std::get_if<FaceTransport>(&transport.scheme)) {
      add_faces(*faces, travelling, shares, clamp, channel, next);
    } else {
      add_operators(std::get<OperatorTransport>(transport.scheme), travelling, shares, channel, next);
    }
  }
  return next;
}

}  // namespace

Volume propagate_step(const Transport& transport, const Volume& travelling, const Volume* geometry,
                      bool clamp) {
  return step(transport, travelling, shares_of(transport, geometry), clamp);
}

Propagation propagate(const Transport& transport, const Volume& injected, const Volume* geometry,
                      int iterations, bool clamp) {
  const std::vector<Plane> shares = shares_of(transport, geometry);
  Propagation result{injected, injected};
  for (int t = 1; t <= iterations; ++t) {
    result.travelling = step(transport, result.travelling, t > 1 ? shares : std::vector<Plane>(), clamp);
    for (std::size_t i = 0; i < result.accumulated.values.size(); ++i) {
      result.accumulated.values[i] += result.travelling.values[i];
    }
  }
  return result;
}

std::array<double, 3> energy(const Basis& basis, const Volume& volume) {
  std::array<double, 3> sum{};
  for (int channel = 0; channel < volume.channels; ++channel) {
    for_each_cell(volume.n,
                  [&](const glm::ivec3& p) { sum[channel] += basis.energy(cell(volume, channel, p)); });
  }
  return sum;
}

std::array<double, 3> leaving(const Basis& basis, const Transport& transport, const Volume& travelling) {
  std::array<double, 3> lost{};
  const auto outside = [&](const glm::ivec3& p) { return !travelling.inside(p.x, p.y, p.z); };
  for_each_cell(travelling.n, [&](const glm::ivec3& p) {
    for (int channel = 0; channel < travelling.channels; ++channel) {
      double& sum = lost[channel];
      std::optional<std::vector<double>> c;
      const auto here = [&]() -> const std::vector<double>& {
        return c ? *c : c.emplace(cell(travelling, channel, p));
      };
      if (const auto* faces = std::get_if<FaceTransport>(&transport.scheme)) {
        for (const Face& face : faces->faces) {
          if (!outside(p + face.travel)) continue;
          const double flux = flux_through(face, here(), true);
          for (int i = 0; i < basis.size(); ++i) {
            sum += flux * faces->lobes(i, column_of(face.normal)) * basis.integrals()[i];
          }
        }
      } else {
        for (const auto& neighbour : std::get<OperatorTransport>(transport.scheme).neighbours) {
          if (outside(p + neighbour.offset)) sum += basis.energy(neighbour.weights * here());
        }
      }
    }
  });
  return lost;
}

}  // namespace clpv::reference
