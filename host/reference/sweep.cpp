// SPDX-License-Identifier: MIT
//   D = I + (1 - f a) sum_k t_k T_k D_k + |w_m| a (f J) s^2   upstream to downstream, per direction
//   L_b s^2 = sum_d Omega_d D_d / (|w_m| Omega_b)
// In a medium: a = 1 - exp(-sigma_t s / |w_m|), J its source function, f the part of a cell in it;
// f and f J are means of the cell and its neighbour upstream along m.
#include "reference/sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <optional>
#include <span>
#include <variant>

#include "basis/sky_light.hpp"
#include "basis/sweep.hpp"
#include "reference/transmittance.hpp"

namespace clpv::reference {
namespace {

/// D of every direction: one volume of 3 channels per direction, [bin * parts^2 + part].
using Fields = std::vector<Volume>;

/// The centre of a fine grid's cell in cells of a coarse grid, from the centre of its first cell.
glm::dvec3 position_in(const ClpvGrid& coarse, const ClpvGrid& fine, const glm::ivec3& cell) {
  const glm::dvec3 centre = vector(fine.origin) + double{fine.cell} * (glm::dvec3(cell) + 0.5);
  return (centre - vector(coarse.origin)) / double{coarse.cell} - 0.5;
}

/// Boundary condition of a cascade: light of the coarser cascade, or of the sky.
struct BoundaryCondition {
  const SweptCascade* cascade = nullptr;  ///< coarser cascade; null: none
  const Fields* fields = nullptr;
  const std::vector<SweepBin>* bins = nullptr;
  std::vector<glm::dvec3> sky =
      {};  ///< radiance of each direction without a coarser cascade; empty: dark
};

/// Sweep of one cascade.
class Sweep {
 public:
  Sweep(const Basis& basis, const Transport& transport, const SweptCascade& cascade,
        const BoundaryCondition& boundary)
      : cascade_(cascade),
        boundary_(boundary),
        n_(cascade.grid.n),
        means_(part_means(basis, cascade.parts)),
        rest_(cosine_rest(basis, means_, cascade.parts)) {
    set_transmittances(std::get<std::vector<SweepLink>>(transport.scheme));
  }

  /// D of one direction.
  Volume direction(int bin, const SweepBin& sweep_bin, int part) const {
    const SweepDirection& d = sweep_bin.directions[part];
    const std::span<const double> means = means_.row(bin * cascade_.parts * cascade_.parts + part);
    Volume field(n_, 1, 3);
    for_each_cell(n_, [&](const glm::ivec3& along) {
      glm::ivec3 p;  // in order from upstream to downstream
      const std::array<int, 3> order = {sweep_bin.axis, sweep_bin.v, sweep_bin.u};
      for (int i = 0; i < 3; ++i) {
        const int axis = order[i], step = along[2 - i];
        p[axis] = sweep_bin.sign[axis] > 0 ? step : n_ - 1 - step;
      }
      const double lacking = rest_ ? lacking_of(p, means) : 0;
      for (int channel = 0; channel < 3; ++channel) {
        double arriving = 0;
        for (std::size_t k = 0; k < d.taps.size(); ++k) {
          const glm::ivec3 q = p - sweep_bin.offset[k];
          const double transmitted =
              transmittance_[link_of(sweep_bin.offset[k])].value(0, 0, p.x, p.y, p.z);
          const double upstream = field.inside(q.x, q.y, q.z)
                                      ? field.value(channel, 0, q.x, q.y, q.z)
                                      : inflow(channel, bin, part, d, q);
          arriving += d.taps[k] * transmitted * upstream;
        }
        const std::vector<double> c = cascade_.injected->cell(channel, p);
        field.at(channel, 0, p.x, p.y, p.z) =
            dot(means, c) + c[0] * lacking + in_medium(channel, bin, sweep_bin, d, p, arriving);
      }
    });
    return field;
  }

 private:
  /// Part that the harmonics of a cell lack of a clamped cosine along a direction, per c_0.
  double lacking_of(const glm::ivec3& p, std::span<const double> means) const {
    std::array<double, 4> c{};
    for (int channel = 0; channel < 3; ++channel)
      for (int i = 0; i < 4; ++i) c[i] += cascade_.injected->value(channel, i, p.x, p.y, p.z);
    const double linear = std::hypot(c[1], c[2], c[3]), uniform = c[0];
    if (uniform <= 0 || linear == 0) return 0;
    const double alpha0 = std::sqrt(std::numbers::pi) / 2, alpha1 = std::sqrt(std::numbers::pi / 3),
                 y1 = std::sqrt(3 / (4 * std::numbers::pi));
    const double r = std::min(1.0, linear / alpha1 / (uniform / alpha0));
    const double z = (means[1] * c[1] + means[2] * c[2] + means[3] * c[3]) / (y1 * linear);
    const auto [e0, e2, e4] = rest_->even;
    return std::pow(r, 4) / alpha0 * (std::abs(z) / 2 - e0 - e2 * z * z - e4 * std::pow(z, 4));
  }

  /// Part of a cell in the medium.
  double inside(const glm::ivec3& p) const {
    const double cell = double{cascade_.grid.cell};
    double part = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double low = cascade_.grid.origin[axis] + cell * p[axis],
                   upper = cascade_.medium->upper[axis], lower = cascade_.medium->lower[axis];
      part *= std::clamp((std::min(low + cell, upper) - std::max(low, lower)) / cell, 0.0, 1.0);
    }
    return part;
  }

  /// Light that has arrived from the previous plane after its way through the medium.
  double in_medium(int channel, int bin, const SweepBin& sweep_bin, const SweepDirection& d,
                   const glm::ivec3& p, double arriving) const {
    if (cascade_.medium == nullptr) return arriving;
    const double lost = -std::expm1(-double{cascade_.medium->extinction[channel]} *
                                    double{cascade_.grid.cell} / d.flux);
    glm::ivec3 upstream = p;
    upstream[sweep_bin.axis] -= sweep_bin.sign[sweep_bin.axis];
    const double here = inside(p) / 2, before = inside(upstream) / 2;
    double scattered = 0;
    if (cascade_.scattered != nullptr) {
      const Volume& source = *cascade_.scattered;
      const glm::ivec3 from = source.inside(upstream.x, upstream.y, upstream.z) ? upstream : p;
      scattered = here * source.value(channel, bin, p.x, p.y, p.z) +
                  before * source.value(channel, bin, from.x, from.y, from.z);
    }
    return arriving + lost * (d.flux * scattered - (here + before) * arriving);
  }

  static std::size_t link_of(const glm::ivec3& offset) {
    return offset.x + 1 + 3 * (offset.y + 1) + 9 * (offset.z + 1);
  }

  void set_transmittances(const std::vector<SweepLink>& links) {
    transmittance_.assign(27, Volume(n_, 1, 1));
    for (const SweepLink& link : links) {
      Volume& transmittances = transmittance_[link_of(link.offset)];
      for_each_cell(n_, [&](const glm::ivec3& p) {
        double& t = transmittances.at(0, 0, p.x, p.y, p.z);
        t = cascade_.geometry == nullptr
                ? 1
                : transmittance(*cascade_.geometry, p, -link.offset, link.blocked_by);
        if (cascade_.occluded != nullptr) t *= seen_share(*cascade_.occluded, n_, p, -link.offset);
      });
    }
  }

  /// Boundary condition at a cell outside this grid: equal radiance on both sides, D = L s^2 |w_m|.
  /// Coarser cells count by the share of sample points in the cell that see them.
  double inflow(int channel, int bin, int part, const SweepDirection& d,
                const glm::ivec3& cell) const {
    if (boundary_.cascade == nullptr) {
      if (boundary_.sky.empty()) return 0;
      const double edge = double{cascade_.grid.cell};
      return boundary_.sky[bin * cascade_.parts * cascade_.parts + part][channel] * edge * edge *
             d.flux;
    }
    const ClpvGrid &fine = cascade_.grid, &coarse = boundary_.cascade->grid;
    const int parts = boundary_.cascade->parts, from = coarser_part(part, cascade_.parts, parts);
    const SweepBin& sweep_bin = (*boundary_.bins)[bin];
    const double edge = double{fine.cell} / coarse.cell;
    return edge * edge * d.flux / sweep_bin.directions[from].flux *
           interpolated((*boundary_.fields)[bin * parts * parts + from], channel,
                        position_in(coarse, fine, cell),
                        position_in(coarse, fine, glm::clamp(cell, 0, n_ - 1)));
  }

  /// Light of the coarser cascade at a place in its cells, by the sample points there that see a
  /// centre which points beyond the place `inner` see, too.
  double interpolated(const Volume& field, int channel, const glm::dvec3& at,
                      const glm::dvec3& inner) const {
    const std::vector<std::uint8_t>* occluded = boundary_.cascade->occluded;
    const std::vector<SeenCentres> points = seen_centres(occluded, n_, at);
    SeenCentres shared;
    const std::vector<SeenCentres> beyond = seen_centres(occluded, n_, inner);
    for (int i = 0; i < 8; ++i) {
      const glm::ivec3 upper(i & 1, i >> 1 & 1, i >> 2);
      const bool in_half = glm::all(
          glm::greaterThanEqual((inner - at) * (2.0 * glm::dvec3(upper) - 1.0), glm::dvec3(0)));
      if (in_half) shared.insert(beyond[i].begin(), beyond[i].end());
    }
    double sum = 0, weights = 0;
    int clear = 0, open = 0;
    for (const SeenCentres& point : points) {
      open += !point.empty();
      if (std::ranges::none_of(point, [&](const auto& centre) { return shared.contains(centre); }))
        continue;
      ++clear;
      for (const auto& [x, y, z] : point) {
        const glm::dvec3 w = 1.0 - glm::abs(at - glm::dvec3(x, y, z));
        weights += w.x * w.y * w.z, sum += w.x * w.y * w.z * field.cell(channel, {x, y, z})[0];
      }
    }
    return weights > 0 ? sum / weights * clear / open : 0;
  }

  SweptCascade cascade_;
  BoundaryCondition boundary_;
  int n_;
  Matrix means_;                       ///< part_means()
  std::optional<CosineRest> rest_;     ///< cosine_rest()
  std::vector<Volume> transmittance_;  ///< by link_of()
};

/// Mean light of each bin, as radiance times s^2.
Volume collect_bins(const std::vector<SweepBin>& bins, const Fields& fields) {
  const int n = fields.front().n;
  Volume sums(n, kSweepBins, 3);
  for (int bin = 0; bin < kSweepBins; ++bin) {
    const SweepBin& sweep_bin = bins[bin];
    const std::size_t parts = sweep_bin.directions.size();
    for (std::size_t part = 0; part < parts; ++part) {
      const SweepDirection& d = sweep_bin.directions[part];
      const Volume& field = fields[static_cast<std::size_t>(bin) * parts + part];
      const double share = d.solid_angle / (d.flux * sweep_bin.solid_angle);
      for (int channel = 0; channel < 3; ++channel) {
        const std::size_t cells = field.values.size() / 3, from = field.index(channel, 0, 0, 0, 0),
                          to = sums.index(channel, bin, 0, 0, 0);
        for (std::size_t i = 0; i < cells; ++i)
          sums.values[to + i] += share * field.values[from + i];
      }
    }
  }
  return sums;
}

}  // namespace

std::vector<Volume> sweep(const Basis& basis, const Transport& transport,
                          const std::vector<SweptCascade>& cascades, const Sky* sky) {
  std::vector<Volume> results(cascades.size());
  Fields coarser;
  std::vector<SweepBin> coarser_bins;
  BoundaryCondition boundary;
  if (sky != nullptr) boundary.sky = sky_means(*sky, cascades.back().parts);
  for (std::size_t c = cascades.size(); c-- > 0;) {
    std::vector<SweepBin> bins = sweep_bins(cascades[c].parts);
    const Sweep sweep(basis, transport, cascades[c], boundary);
    Fields fields;
    for (int bin = 0; bin < kSweepBins; ++bin) {
      for (int part = 0; part < cascades[c].parts * cascades[c].parts; ++part)
        fields.push_back(sweep.direction(bin, bins[bin], part));
    }
    results[c] = collect_bins(bins, fields);
    coarser = std::move(fields);
    coarser_bins = std::move(bins);
    boundary = {&cascades[c], &coarser, &coarser_bins};
  }
  return results;
}

Volume project_bins(const Volume& swept) {
  const Matrix projection = swept_projection();
  Volume result(swept.n, projection.rows(), 3);
  const std::size_t cells = swept.values.size() / (3 * kSweepBins);
  for (int channel = 0; channel < 3; ++channel) {
    for (int j = 0; j < projection.rows(); ++j) {
      const std::size_t to = result.index(channel, j, 0, 0, 0);
      for (int bin = 0; bin < kSweepBins; ++bin) {
        const std::size_t from = swept.index(channel, bin, 0, 0, 0);
        for (std::size_t i = 0; i < cells; ++i)
          result.values[to + i] += projection(j, bin) * swept.values[from + i];
      }
    }
  }
  return result;
}

}  // namespace clpv::reference
