// SPDX-License-Identifier: MIT
#include "basis/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "basis/bases.hpp"
#include "basis/quadrature.hpp"
#include "basis/sampling.hpp"

namespace clpv {
namespace {

constexpr int kSide = 2;  // bins along each edge of a cube's face
constexpr int kSweptBands = 3;

/// Part (i, j) of a bin: divided at equal angles between axis and diagonal, as bins96 divides
/// bins24.
SphericalPolygon part_polygon(int bin, int parts, int i, int j) {
  const auto lines = [&](int side, int step) -> std::array<double, 2> {
    const double sign = side == 0 ? -1 : 1, angle = std::numbers::pi / 4;
    return {sign * std::tan(angle * step / parts), sign * std::tan(angle * (step + 1) / parts)};
  };
  return face_region(bin / (kSide * kSide), lines(bin % kSide, i), lines(bin / kSide % kSide, j));
}

SweepDirection direction_of(const SphericalPolygon& polygon, const SweepBin& bin) {
  SweepDirection direction{};
  glm::dvec3 sum(0);
  for (const QuadratureNode& node : nodes_of(polygon)) {
    direction.solid_angle += node.weight;
    sum += node.weight * node.w;
  }
  direction.w = glm::normalize(sum);
  direction.flux = std::abs(direction.w[bin.axis]);
  const double tu = std::abs(direction.w[bin.u]) / direction.flux,
               tv = std::abs(direction.w[bin.v]) / direction.flux;
  direction.taps = {(1 - tu) * (1 - tv), tu * (1 - tv), (1 - tu) * tv, tu * tv};
  return direction;
}

}  // namespace

std::vector<SweepBin> sweep_bins(int parts) {
  std::vector<SweepBin> bins;
  for (int b = 0; b < kSweepBins; ++b) {
    const FaceAxes axes = axes_of(b / (kSide * kSide));
    // u is the plane's fastest axis in memory: x if the plane contains x.
    const int u = axes.n == 0 ? 1 : 0, v = axes.n == 2 ? 1 : 2;
    SweepBin bin{axes.n, u, v, {}, {}, 0, {}};
    bin.sign[axes.n] = axes.sign < 0 ? -1 : 1;
    bin.sign[axes.u] = b % kSide == 0 ? -1 : 1;
    bin.sign[axes.v] = b / kSide % kSide == 0 ? -1 : 1;
    for (std::size_t k = 0; k < bin.offset.size(); ++k) {
      bin.offset[k] = glm::ivec3(0);
      bin.offset[k][bin.axis] = bin.sign[bin.axis];
      if (k % 2 == 1) bin.offset[k][u] = bin.sign[u];
      if (k / 2 == 1) bin.offset[k][v] = bin.sign[v];
    }
    for (int j = 0; j < parts; ++j) {
      for (int i = 0; i < parts; ++i) {
        bin.directions.push_back(direction_of(part_polygon(b, parts, i, j), bin));
        bin.solid_angle += bin.directions.back().solid_angle;
      }
    }
    bins.push_back(std::move(bin));
  }
  return bins;
}

SubBin sub_bin_along(const glm::dvec3& w, int parts) {
  const glm::dvec3 size = glm::abs(w);
  const int n = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const int u = (n + 1) % 3, v = (n + 2) % 3, face = 2 * n + (w[n] < 0 ? 1 : 0);
  const auto index_along = [&](int axis) {  // index of the part along `axis`
    int before = 0;
    while (before + 1 < parts &&
           size[axis] >= std::tan(std::numbers::pi / 4 * (before + 1) / parts) * size[n])
      ++before;
    return before;
  };
  const int bin = face * kSide * kSide + (w[v] < 0 ? 0 : kSide) + (w[u] < 0 ? 0 : 1);
  return {bin, index_along(v) * parts + index_along(u)};
}

int coarser_part(int part, int parts, int coarser_parts) {
  const auto along = [&](int i) { return (2 * i + 1) * coarser_parts / (2 * parts); };
  return along(part / parts) * coarser_parts + along(part % parts);
}

Matrix part_means(const Basis& basis, int parts) {
  const int of_bin = parts * parts;
  Matrix means(kSweepBins * of_bin, basis.size());
  for (int d = 0; d < means.rows(); ++d) {
    const int part = d % of_bin;
    const SphericalPolygon whole = part_polygon(d / of_bin, parts, part % parts, part / parts);
    double total = 0;
    for (const SphericalPolygon& piece : split({whole}, basis.creases())) {
      for (const QuadratureNode& node : nodes_of(piece)) {
        const std::vector<double> b = basis.evaluate(node.w);
        for (int i = 0; i < basis.size(); ++i) means(d, i) += node.weight * b[i];
        total += node.weight;
      }
    }
    constexpr double kZero = 1e-14;  // means below are rounding errors of 0
    for (double& mean : means.row(d)) {
      mean /= total;
      if (std::abs(mean) < kZero) mean = 0;
    }
  }
  return means;
}

std::optional<CosineRest> cosine_rest(const Basis& basis, const Matrix& means, int parts) {
  if (basis.bands() < 2) return std::nullopt;
  // Clamped cosine in Legendre polynomials: 1/4 + z/2 + 5/16 P_2 - 3/32 P_4 and on.
  CosineRest rest{};
  if (basis.bands() > 2) rest.even[1] = 15.0 / 32;
  if (basis.bands() > 4) rest.even[1] += 90.0 / 256, rest.even[2] = -105.0 / 256;
  const double y1 = basis.evaluate(glm::dvec3(0, 0, 1))[2];
  const std::vector<SweepBin> bins = sweep_bins(parts);
  for (int d = 0; d < means.rows(); ++d) {
    const glm::dvec3 mean = glm::dvec3(means(d, 3), means(d, 1), means(d, 2)) / y1;
    const double square = glm::dot(mean, mean);
    const double share = bins[d / (parts * parts)].directions[d % (parts * parts)].solid_angle /
                         (4 * std::numbers::pi);
    rest.even[0] += share * (std::sqrt(square) / 4 - rest.even[1] * square / 3 -
                             rest.even[2] * square * square / 5);
  }
  return rest;
}

std::unique_ptr<Basis> swept_basis() {
  return std::make_unique<SphericalHarmonics>(kSweptBands);
}

Matrix swept_projection() {
  const DirectionBins bins(kSide);
  const std::unique_ptr<Basis> harmonics = swept_basis();
  Matrix projection(harmonics->size(), kSweepBins);
  for (const QuadratureNode& node : quadrature(bins, octants())) {
    const std::vector<double> in = bins.evaluate(node.w), y = harmonics->evaluate(node.w);
    for (int j = 0; j < projection.rows(); ++j) {
      for (int bin = 0; bin < kSweepBins; ++bin) projection(j, bin) += node.weight * y[j] * in[bin];
    }
  }
  return projection;
}

Matrix scattering_matrix(double anisotropy) {
  const std::vector<SweepBin> bins = sweep_bins(kMaxSweepParts);
  Matrix matrix(kSweepBins, kSweepBins);
  for (int to = 0; to < kSweepBins; ++to) {
    double sum = 0;
    for (int from = 0; from < kSweepBins; ++from) {
      for (const SweepDirection& after : bins[to].directions) {
        for (const SweepDirection& before : bins[from].directions) {
          const double cosine = std::clamp(glm::dot(after.w, before.w), -1.0, 1.0);
          matrix(to, from) += after.solid_angle * before.solid_angle * phase(anisotropy, cosine);
        }
      }
      sum += matrix(to, from);
    }
    for (double& entry : matrix.row(to)) entry /= sum;
  }
  return matrix;
}

void close_diagonals(std::vector<SweepLink>& links, double power) {
  for (SweepLink& link : links) {
    const double factor = std::pow(glm::length(glm::dvec3(link.offset)), power);
    for (double& weight : link.blocked_by) weight *= factor;
  }
}

std::vector<SweepLink> sweep_links() {
  std::vector<SweepLink> links;
  for (int i = 0; i < 27; ++i) {
    const glm::ivec3 offset(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (offset != glm::ivec3(0)) links.push_back({offset, glm::normalize(glm::dvec3(offset)), {}});
  }
  return links;
}

static int link_number(const glm::ivec3& offset) {
  const int number = (offset.x + 1) + 3 * (offset.y + 1) + 9 * (offset.z + 1);
  return number - (number > 13 ? 1 : 0);  // 13 is the cell itself
}

int LinkVolumes::volume(int axis, const glm::ivec3& offset) const {
  int before = 0;
  for (int i = 0; i < axis; ++i) before += static_cast<int>(across[i].size());
  return before + static_cast<int>(std::ranges::find(across[axis], link_number(offset)) -
                                   across[axis].begin());
}

LinkVolumes link_volumes() {
  LinkVolumes links;
  for (const SweepBin& bin : sweep_bins(1)) {
    std::vector<int>& across = links.across[bin.axis];
    for (const glm::ivec3& offset : bin.offset) {
      if (std::ranges::find(across, link_number(offset)) == across.end())
        across.push_back(link_number(offset));
    }
  }
  return links;
}

}  // namespace clpv
