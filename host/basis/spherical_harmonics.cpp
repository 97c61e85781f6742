// SPDX-License-Identifier: MIT
#include "basis/spherical_harmonics.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "basis/clamped_cosine.hpp"

namespace clpv {
namespace {

using std::numbers::pi;

// Coefficients of the Legendre polynomial P_l, [i] for z^i: (n+1) P_{n+1} = (2n+1) z P_n - n
// P_{n-1}.
std::vector<double> legendre(int l) {
  std::vector<double> before{0}, now{1};
  for (int n = 0; n < l; ++n) {
    std::vector<double> next(static_cast<std::size_t>(n) + 2, 0.0);
    for (std::size_t i = 0; i < now.size(); ++i) next[i + 1] += (2.0 * n + 1) / (n + 1) * now[i];
    for (std::size_t i = 0; i < before.size(); ++i)
      next[i] -= static_cast<double>(n) / (n + 1) * before[i];
    before = now;
    now = next;
  }
  return now;
}

std::vector<double> derivative(const std::vector<double>& p) {
  std::vector<double> d;
  for (std::size_t i = 1; i < p.size(); ++i) d.push_back(static_cast<double>(i) * p[i]);
  return d;
}

// K_lm, the normalisation of Y_lm.
double norm(int l, int m) {
  double ratio = 1;  // (l - m)! / (l + m)!
  for (int i = l - m + 1; i <= l + m; ++i) ratio /= i;
  return std::sqrt((2 * l + 1) / (4 * pi) * ratio * (m == 0 ? 1 : 2));
}

double value_of(const std::vector<double>& polynomial, double z) {
  double sum = 0;
  for (std::size_t i = polynomial.size(); i-- > 0;) sum = sum * z + polynomial[i];
  return sum;
}

}  // namespace

SphericalHarmonics::SphericalHarmonics(int bands) : bands_(bands) {
  name_ = fmt::format("sh{}", bands);
  size_ = bands * bands;
  for (int l = 0; l < bands; ++l) {
    for (int m = -l; m <= l; ++m) {
      std::vector<double> p = legendre(l);
      for (int i = 0; i < std::abs(m); ++i) p = derivative(p);
      for (double& c : p) c *= norm(l, std::abs(m));
      functions_.push_back({l, m, p});
    }
  }
  std::vector<double> integrals(size_, 0.0);
  integrals[0] = std::sqrt(4 * pi);
  set_gram(Matrix::identity(size_), integrals);
}

void SphericalHarmonics::evaluate(const glm::dvec3& w, std::span<double> b) const {
  std::vector<double> re{1}, im{0};  // (x + iy)^m
  for (int m = 1; m < bands_; ++m) {
    re.push_back(w.x * re.back() - w.y * im.back());
    im.push_back(w.x * im.back() + w.y * re[re.size() - 2]);
  }
  for (std::size_t i = 0; i < functions_.size(); ++i) {
    const Function& f = functions_[i];
    const std::size_t m = std::abs(f.order);
    b[i] = (f.order < 0 ? im[m] : re[m]) * value_of(f.polynomial, w.z);
  }
}

void SphericalHarmonics::cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const {
  evaluate(d, alpha);
  for (std::size_t i = 0; i < functions_.size(); ++i) alpha[i] *= cosine_band(functions_[i].band);
}

void SphericalHarmonics::add_literals(Literals& literals) const {
  Matrix values(size_, (bands_ + 1) / 2), cosines = values;
  for (int i = 0; i < size_; ++i) {
    const Function& f = functions_[i];
    // Q_lm is even or odd in z: a polynomial in z^2, times z if odd.
    const std::size_t odd = (f.polynomial.size() - 1) % 2;
    for (std::size_t k = odd; k < f.polynomial.size(); k += 2) {
      values(i, static_cast<int>(k / 2)) = f.polynomial[k];
      cosines(i, static_cast<int>(k / 2)) = cosine_band(f.band) * f.polynomial[k];
    }
  }
  literals.word("CLPV_BASIS", "CLPV_HARMONICS")
      .integer("CLPV_BANDS", bands_)
      .matrix("CLPV_Y", values)
      .matrix("CLPV_COSINE_Y", cosines);
}

}  // namespace clpv
