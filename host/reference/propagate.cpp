#include "reference/propagate.hpp"

#include <algorithm>
#include <optional>

#include "reference/transmit.hpp"

namespace clpv::reference {
namespace {

std::vector<double> cell(const Volume& volume, int channel, const glm::ivec3& p) {
  std::vector<double> c(static_cast<std::size_t>(volume.coefficients));
  for (int i = 0; i < volume.coefficients; ++i)
    c[static_cast<std::size_t>(i)] = volume.value(channel, i, p.x, p.y, p.z);
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

void add_faces(const FaceTransport& scheme, const Volume& from, const Volume* geometry, bool clamp,
               const glm::ivec3& p, Volume& to) {
  for (const Face& face : scheme.faces) {
    const double open = geometry == nullptr ? 1.0 : transmitted(*geometry, p, face.normal, face.blocked_by);
    for (int channel = 0; channel < from.channels; ++channel) {
      const double flux = open * flux_through(face, cell(from, channel, p - face.travel), clamp);
      for (int i = 0; i < from.coefficients; ++i)
        to.at(channel, i, p.x, p.y, p.z) += flux * scheme.lobes(i, column_of(face.normal));
    }
  }
}

void add_operators(const OperatorTransport& scheme, const Volume& from, const Volume* geometry,
                   const glm::ivec3& p, Volume& to) {
  for (const OperatorTransport::Neighbour& neighbour : scheme.neighbours) {
    const bool blocks = geometry != nullptr && neighbour.offset != glm::ivec3(0);
    const double open = blocks ? transmitted(*geometry, p, -neighbour.offset, neighbour.blocked_by) : 1.0;
    for (int channel = 0; channel < from.channels; ++channel) {
      const std::vector<double> arrived = neighbour.weights * cell(from, channel, p - neighbour.offset);
      for (int i = 0; i < from.coefficients; ++i)
        to.at(channel, i, p.x, p.y, p.z) += open * arrived[static_cast<std::size_t>(i)];
    }
  }
}

template <typename Visit>
void for_each_cell(int n, Visit visit) {
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int x = 0; x < n; ++x) visit(glm::ivec3(x, y, z));
    }
  }
}

}  // namespace

Volume propagate_step(const Transport& transport, const Volume& travelling, const Volume* geometry,
                      bool clamp) {
  Volume next(travelling.n, travelling.coefficients, travelling.channels);
  for_each_cell(next.n, [&](const glm::ivec3& p) {
    if (const auto* faces = std::get_if<FaceTransport>(&transport.scheme)) {
      add_faces(*faces, travelling, geometry, clamp, p, next);
    } else {
      add_operators(std::get<OperatorTransport>(transport.scheme), travelling, geometry, p, next);
    }
  });
  return next;
}

Propagation propagate(const Transport& transport, const Volume& injected, const Volume* geometry,
                      int iterations, bool clamp) {
  Propagation result{injected, injected};
  for (int step = 1; step <= iterations; ++step) {
    result.travelling = propagate_step(transport, result.travelling, step > 1 ? geometry : nullptr, clamp);
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
      sum[static_cast<std::size_t>(channel)] += basis.energy(cell(volume, channel, p));
    });
  }
  return sum;
}

std::array<double, 3> leaving(const Basis& basis, const Transport& transport, const Volume& travelling) {
  std::array<double, 3> lost{};
  const auto outside = [&](const glm::ivec3& p) { return !travelling.inside(p.x, p.y, p.z); };
  for_each_cell(travelling.n, [&](const glm::ivec3& p) {
    for (int channel = 0; channel < travelling.channels; ++channel) {
      double& sum = lost[static_cast<std::size_t>(channel)];
      std::optional<std::vector<double>> c;
      const auto here = [&]() -> const std::vector<double>& {
        return c ? *c : c.emplace(cell(travelling, channel, p));
      };
      if (const auto* faces = std::get_if<FaceTransport>(&transport.scheme)) {
        for (const Face& face : faces->faces) {
          if (!outside(p + face.travel)) continue;
          const double flux = flux_through(face, here(), true);
          for (int i = 0; i < basis.size(); ++i) {
            sum += flux * faces->lobes(i, column_of(face.normal)) *
                   basis.integrals()[static_cast<std::size_t>(i)];
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
