// SPDX-License-Identifier: MIT
#include "basis/gather_form.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "basis/quadrature.hpp"
#include "basis/spherical_harmonics.hpp"

namespace clpv {
namespace {

using std::numbers::pi;

constexpr int kBands = 3;
constexpr int kMostFunctions = kBands * kBands;  // of a basis that is gathered as it is
constexpr int kLobes = 100,
              kNormals = 400;  // directions the window is found from: 10 and 20 times closer than lobes

/// Int Y_lm(n) Int b(w) max(0, -w . n) dw dn = (-1)^l A_l Int Y_lm b dw, and looked up at -n the sign goes (Funk and
/// Hecke; A_l of Ramamoorthi & Hanrahan 2001).
constexpr std::array<double, kBands> kCosineFactors = {pi, 2 * pi / 3, pi / 4};

/// The projection of alpha(n) on harmonics: one row each.
Matrix cosine_projection(const Basis& harmonics, const Basis& basis) {
  Matrix projection(harmonics.size(), basis.size());
  for (const QuadratureNode& node : quadrature(basis, octants())) {
    const std::vector<double> y = harmonics.evaluate(node.w), b = basis.evaluate(node.w);
    for (int j = 0; j < projection.rows(); ++j) {
      const double factor = node.weight * y[j] * kCosineFactors[std::sqrt(j + 0.5)];
      for (int i = 0; i < projection.columns(); ++i) projection(j, i) += factor * b[i];
    }
  }
  return projection;
}

Matrix scaled_identity(int n, double scale) {
  Matrix result(n, n);
  for (int i = 0; i < n; ++i) result(i, i) = scale;
  return result;
}

/// Directions spread evenly over the sphere, on a spiral of the golden angle.
std::vector<glm::dvec3> spread(int count) {
  std::vector<glm::dvec3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z),
                 turn = i * pi * (3 - std::sqrt(5.0));
    directions.emplace_back(r * std::cos(turn), r * std::sin(turn), z);
  }
  return directions;
}

}  // namespace

GatherForm::GatherForm(const Basis& basis, const Transport& transport) : basis_(&basis) {
  if (!transport.gathers_cosine) {
    matrix_ = scaled_identity(basis.size(), 4);
  } else if (basis.size() <= kMostFunctions) {
    integrates_ = true;
    matrix_ = transport.gather;
  } else {
    harmonics_ = std::make_shared<SphericalHarmonics>(kBands);
    matrix_ = cosine_projection(*harmonics_, basis) * transport.gather;
  }
  // The mean of max(0, w . d) over d is 1/4.
  for (const double integral : functions().integrals())
    mean_.push_back(integral * (integrates_ ? 0.25 : 0.25 / pi));
  if (transport.gathers_cosine && transport.kind != TransportKind::sweep) window_ = least_window();
}

std::vector<double> GatherForm::evaluate(const glm::dvec3& w) const {
  if (!integrates_) return functions().evaluate(w);
  std::vector<double> alpha(static_cast<std::size_t>(functions().size()));
  functions().cosine_integrals(w, alpha);
  return alpha;
}

std::vector<double> GatherForm::windowed(std::vector<double> f) const {
  for (std::size_t i = 0; i < f.size(); ++i) f[i] += window_ * (mean_[i] - f[i]);
  return f;
}

double GatherForm::least_window() const {
  std::vector<std::vector<double>> looked_up;
  for (const glm::dvec3& n : spread(kNormals)) looked_up.push_back(evaluate(n));
  double window = 0;
  for (const glm::dvec3& d : spread(kLobes)) {
    const std::vector<double> gathered = matrix_ * basis_->clamped_cosine(d);
    const double mean = dot(mean_, gathered);
    double least = 0;
    for (const std::vector<double>& f : looked_up) least = std::min(least, dot(f, gathered));
    // (1 - window) least + window mean = 0. A lobe of no light to speak of says nothing.
    if (mean > 0) window = std::max(window, least / (least - mean));
  }
  return window;
}

}  // namespace clpv
