// SPDX-License-Identifier: MIT
#include "basis/centre_objective.hpp"

#include <cmath>
#include <functional>
#include <numbers>

#include "basis/clamped_cosine.hpp"

namespace clpv {
namespace {

using std::numbers::pi;
constexpr double kNorm = 2 * pi / 3;  // Int max(0, w . d)^2 dw
constexpr int kBands = 1024;  // at lambda = 0.9 the series of M ends at band 190, that of alpha at 370

std::vector<double> bands(int power) {
  std::vector<double> c;
  for (int l = 0; l < kBands; ++l) c.push_back((2 * l + 1) * std::pow(cosine_band(l), power));
  return c;
}

/// 4 pi G(t; mu) with its derivatives.
ZonalValue gram_entry(double t, double mu) {
  const double d = 1 - 2 * mu * t + mu * mu, numerator = 1 - mu * mu;
  const double cubed = 4 * pi / (d * std::sqrt(d));
  return {numerator * cubed, 3 * mu * numerator * cubed / d,
          cubed * (-2 * mu + 3 * numerator * (t - mu) / d)};
}

/// `function` of the pair of centres i and j.
ZonalValue pair_value(const CentreSet& set, std::size_t i, std::size_t j,
                      const std::function<ZonalValue(double t, double mu)>& function) {
  const double t = i == j ? 1 : glm::dot(set.centres[i], set.centres[j]);
  return function(std::min(1.0, std::max(-1.0, t)), set.lambdas[i] * set.lambdas[j]);
}

/// N x N matrix of `function` over all pairs of centres.
Matrix pair_matrix(const CentreSet& set, const std::function<ZonalValue(double t, double mu)>& function) {
  const auto n = static_cast<int>(set.centres.size());
  Matrix m(n, n);
  for (int i = 0; i < n; ++i) {
    for (int j = i; j < n; ++j)
      m(i, j) = m(j, i) =
          pair_value(set, static_cast<std::size_t>(i), static_cast<std::size_t>(j), function).value;
  }
  return m;
}

/// Adds the gradient of sum_ij weights_ij function_ij.
void add_gradient(SetValue& sum, const CentreSet& set, const Matrix& weights,
                  const std::function<ZonalValue(double t, double mu)>& function) {
  for (std::size_t i = 0; i < set.centres.size(); ++i) {
    for (std::size_t j = 0; j < set.centres.size(); ++j) {
      const ZonalValue entry = pair_value(set, i, j, function);
      const double twice = 2 * weights(static_cast<int>(i), static_cast<int>(j));
      if (i != j) sum.by_centre[i] += twice * entry.by_t * set.centres[j];
      sum.by_lambda[i] += twice * entry.by_mu * set.lambdas[j];
    }
  }
}

Matrix scaled(Matrix m, double factor) {
  for (int i = 0; i < m.rows(); ++i) {
    for (double& value : m.row(i)) value *= factor;
  }
  return m;
}

double trace(const Matrix& m) {
  double sum = 0;
  for (int i = 0; i < m.rows(); ++i) sum += m(i, i);
  return sum;
}

/// SetValue of zeros for `set`.
SetValue zero_value(const CentreSet& set) {
  return {0, std::vector<glm::dvec3>(set.centres.size(), glm::dvec3(0)),
          std::vector<double>(set.centres.size(), 0.0)};
}

/// alpha_i of every aim, with derivatives.
struct Alphas {
  std::vector<std::vector<ZonalValue>> each;  ///< [aim][centre]
  Matrix moment;                              ///< <alpha alpha^T>
};

Alphas alphas_of(const CentreSet& set, const LobeAims& aims, const ZonalSeries& cosine) {
  const auto n = static_cast<int>(set.centres.size());
  Alphas alphas{{}, Matrix(n, n)};
  for (const WeightedDirection& aim : aims.directions) {
    std::vector<ZonalValue>& alpha = alphas.each.emplace_back();
    for (std::size_t i = 0; i < set.centres.size(); ++i)
      alpha.push_back(cosine(glm::dot(set.centres[i], aim.direction), set.lambdas[i]));
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        alphas.moment(i, j) += aim.weight * alpha[i].value * alpha[j].value;
      }
    }
  }
  return alphas;
}

/// Adds the gradient of -sum_ij s_ij M_ij / kNorm.
void add_gradient(SetValue& sum, const Alphas& alphas, const LobeAims& aims, const Matrix& s) {
  for (std::size_t a = 0; a < aims.directions.size(); ++a) {
    std::vector<double> values;
    for (const ZonalValue& alpha : alphas.each[a]) values.push_back(alpha.value);
    const std::vector<double> product = s * values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double factor = -2 * aims.directions[a].weight * product[i] / kNorm;
      sum.by_centre[i] += factor * alphas.each[a][i].by_t * aims.directions[a].direction;
      sum.by_lambda[i] += factor * alphas.each[a][i].by_mu;
    }
  }
}

}  // namespace

CentreObjective::CentreObjective(LobeAims aims)
    : aims_(std::move(aims)), cosine_(bands(1)), second_moment_(bands(2)) {}

SetValue CentreObjective::square_error(const CentreSet& set) const {
  // d tr(S M) = tr(S dM) - tr(S M S dA), S = A^-1.
  const Matrix s = inverse(pair_matrix(set, gram_entry));
  SetValue error = zero_value(set);
  Alphas alphas;
  const bool all = aims_.directions.empty();
  if (!all) alphas = alphas_of(set, aims_, cosine_);
  const Matrix moment = all ? pair_matrix(set, second_moment_) : alphas.moment;
  const Matrix product = s * moment;
  error.value = 1 - trace(product) / kNorm;
  add_gradient(error, set, scaled(product * s, 1 / kNorm), gram_entry);
  if (all) {
    add_gradient(error, set, scaled(s, -1 / kNorm), second_moment_);
  } else {
    add_gradient(error, alphas, aims_, s);
  }
  return error;
}

SetValue CentreObjective::log_condition(const CentreSet& set) const {
  const Matrix gram = pair_matrix(set, gram_entry), s = inverse(gram);
  const double size = trace(gram), inverse_size = trace(s);
  SetValue bound = zero_value(set);
  bound.value = std::log(size * inverse_size);
  Matrix weights = scaled(s * s, -1 / inverse_size);
  for (int i = 0; i < weights.rows(); ++i) weights(i, i) += 1 / size;
  add_gradient(bound, set, weights, gram_entry);
  return bound;
}

}  // namespace clpv
