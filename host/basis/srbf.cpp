// SPDX-License-Identifier: MIT
#include "basis/srbf.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/error.hpp"

namespace clpv {
namespace {

using std::numbers::pi;

std::vector<glm::dvec3> axes() {
  return {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
}

std::vector<glm::dvec3> cube() {
  std::vector<glm::dvec3> corners;
  for (const double z : {1.0, -1.0}) {
    for (const double y : {1.0, -1.0}) {
      for (const double x : {1.0, -1.0}) corners.push_back(glm::dvec3(x, y, z) / std::sqrt(3.0));
    }
  }
  return corners;
}

// Adds three directions with z-coordinate z, 120 degrees apart.
void add_ring(std::vector<glm::dvec3>& centres, double z, double first_degrees) {
  const double radius = std::sqrt(1 - z * z);
  for (int i = 0; i < 3; ++i) {
    const double azimuth = (first_degrees + 120 * i) * pi / 180;
    centres.emplace_back(radius * std::cos(azimuth), radius * std::sin(azimuth), z);
  }
}

// The rings are 60 degrees apart: a relative rotation changes the lobe error between 0.196 and
// 0.308.
std::vector<glm::dvec3> two_rings() {
  std::vector<glm::dvec3> centres{{0, 0, 1}, {0, 0, -1}};
  add_ring(centres, 1.0 / 3, 0);
  add_ring(centres, -1.0 / 3, 60);
  return centres;
}

std::vector<glm::dvec3> tetrahedron() {
  std::vector<glm::dvec3> centres{{0, 0, 1}};
  add_ring(centres, -1.0 / 3, 0);
  return centres;
}

std::vector<glm::dvec3> joined(std::vector<glm::dvec3> a, const std::vector<glm::dvec3>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// For each centre, the index of an earlier centre that is its antipode with equal lambda, else its
/// own index.
std::vector<int> opposites_of(const Basis& basis) {
  std::vector<int> opposites;
  for (std::size_t i = 0; i < basis.centres().size(); ++i) {
    opposites.push_back(static_cast<int>(i));
    for (std::size_t j = 0; j < i; ++j) {
      const glm::dvec3 sum = basis.centres()[i] + basis.centres()[j];
      if (glm::dot(sum, sum) < 1e-24 && basis.lambdas()[i] == basis.lambdas()[j])
        opposites[i] = static_cast<int>(j);
    }
  }
  return opposites;
}

// Coefficients in u = t^2 of a Chebyshev series in x = 2u - 1.
std::vector<double> powers_of(const std::vector<double>& chebyshev) {
  std::vector<double> before{1}, now{-1, 2}, sum(chebyshev.size(), 0.0);  // T_0, T_1 in u
  const auto add = [&](const std::vector<double>& p, double c) {
    for (std::size_t i = 0; i < p.size(); ++i) sum[i] += c * p[i];
  };
  add(before, chebyshev[0]);
  for (std::size_t k = 1; k < chebyshev.size(); ++k) {
    add(now, chebyshev[k]);
    std::vector<double> next(now.size() + 1, 0.0);
    for (std::size_t i = 0; i < now.size(); ++i) {
      next[i + 1] += 4 * now[i];
      next[i] -= 2 * now[i];
    }
    for (std::size_t i = 0; i < before.size(); ++i) next[i] -= before[i];
    before = now;
    now = next;
  }
  return sum;
}

/// Returns true if the powers' terms cancel, as they do for lambda above about 0.5.
bool cancels(const std::vector<double>& powers, const std::vector<double>& chebyshev) {
  constexpr double kCancellation = 4;  // two bits of a float's 24
  double size = 0;
  for (const double term : powers) size += std::abs(term);
  return size >= kCancellation * chebyshev[0];
}

void require_usable(const std::string& name, const std::vector<glm::dvec3>& centres,
                    const std::vector<double>& lambdas) {
  if (centres.empty() || centres.size() > kMaxCentres) {
    throw Error(ExitCode::usage, "{}: found {} centres, allowed: 1 to {}", name, centres.size(),
                kMaxCentres);
  }
  for (const double lambda : lambdas) {
    if (!(lambda > 0 && lambda < 1)) {
      throw Error(ExitCode::usage, "{}: lambda: found {}, allowed: greater than 0 and less than 1",
                  name, lambda);
    }
  }
  for (std::size_t i = 0; i < centres.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = glm::length(centres[i] - centres[j]);
      if (!(distance >= kMinCentreDistance)) {
        throw Error(ExitCode::usage,
                    "{}: centres {} and {}: found a distance of {:.2g}, allowed: at least {}", name,
                    j, i, distance, kMinCentreDistance);
      }
    }
  }
}

}  // namespace

double abel_poisson(double t, double lambda) {
  const double d = 1 - 2 * lambda * t + lambda * lambda;
  return (1 - lambda * lambda) / (d * std::sqrt(d));
}

const std::vector<SrbfSet>& srbf_sets() {
  static const std::vector<SrbfSet> sets{
      {"srbf4", tetrahedron()},
      {"srbf6", axes()},
      {"srbf8v1", two_rings()},
      {"srbf8v2", cube()},
      {"srbf8v3",
       joined(axes(), {glm::dvec3(1) / std::sqrt(3.0), glm::dvec3(-1) / std::sqrt(3.0)})},
      {"srbf14", joined(cube(), axes())},
  };
  return sets;
}

Srbf::Srbf(const std::string& name, const std::vector<glm::dvec3>& centres,
           const std::vector<double>& lambdas) {
  require_usable(name, centres, lambdas);
  name_ = name;
  lambdas_ = lambdas;
  centres_ = centres;
  size_ = centres.size();
  for (const double lambda : lambdas) cosines_.try_emplace(lambda, lambda);
  Matrix gram(size_, size_);
  for (int i = 0; i < size_; ++i) {
    for (int j = 0; j < size_; ++j) {
      const std::size_t a = i, b = j;
      const double t = i == j ? 1 : glm::dot(centres_[a], centres_[b]);
      gram(i, j) = 4 * pi * abel_poisson(t, lambdas_[a] * lambdas_[b]);
    }
  }
  set_gram(std::move(gram), std::vector<double>(centres.size(), 4 * pi));
}

void Srbf::evaluate(const glm::dvec3& w, std::span<double> b) const {
  for (std::size_t i = 0; i < centres_.size(); ++i)
    b[i] = abel_poisson(glm::dot(w, centres_[i]), lambdas_[i]);
}

void Srbf::cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const {
  for (std::size_t i = 0; i < centres_.size(); ++i)
    alpha[i] = cosines_.at(lambdas_[i])(glm::dot(d, centres_[i]));
}

void Srbf::add_literals(Literals& literals) const {
  std::map<double, std::vector<double>> chebyshev, powers;
  std::size_t terms = 1;
  bool by_chebyshev = false;
  for (const auto& [lambda, cosine] : cosines_) {
    chebyshev[lambda] = cosine.chebyshev();
    powers[lambda] = powers_of(chebyshev[lambda]);
    terms = std::max(terms, chebyshev[lambda].size());
    by_chebyshev = by_chebyshev || cancels(powers[lambda], chebyshev[lambda]);
  }
  Matrix centres(size_, 3), poisson(size_, 3), even(size_, static_cast<int>(terms));
  std::vector<double> slope;
  for (int i = 0; i < size_; ++i) {
    const double lambda = lambdas_[i];
    for (int axis = 0; axis < 3; ++axis) centres(i, axis) = centres_[i][axis];
    const double numbers[] = {1 - lambda * lambda, 1 + lambda * lambda, 2 * lambda};
    std::ranges::copy(numbers, poisson.row(i).begin());
    std::ranges::copy((by_chebyshev ? chebyshev : powers)[lambda], even.row(i).begin());
    slope.push_back(cosines_.at(lambda).slope());
  }
  literals.word("CLPV_BASIS", "CLPV_RADIAL")
      .matrix("CLPV_CENTRES", centres)
      .integers("CLPV_OPPOSITES", opposites_of(*this))
      .matrix("CLPV_POISSON", poisson)
      .reals("CLPV_COSINE_SLOPE", slope)
      .integer("CLPV_COSINE_TERMS", terms)
      .flag("CLPV_COSINE_CHEBYSHEV", by_chebyshev)
      .matrix("CLPV_COSINE_EVEN", even);
}

}  // namespace clpv
