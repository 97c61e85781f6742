// SPDX-License-Identifier: MIT
#include "basis/operator_transport.hpp"

#include <algorithm>
#include <cmath>

#include "basis/quadrature.hpp"

namespace clpv {
namespace {

// Rounding errors of exact zeros: generated kernels skip what is 0.
constexpr double kZero = 1e-14;

double manhattan(const glm::dvec3& w) {
  return std::abs(w.x) + std::abs(w.y) + std::abs(w.z);
}

double upwind_weight(const glm::ivec3& k, const glm::dvec3& w) {
  return std::max(0.0, glm::dot(glm::dvec3(k), w)) / manhattan(w);
}

// sum += weight b b^T. Direction bins have one function that is not 0.
void add_outer(Matrix& sum, double weight, const std::vector<double>& b) {
  for (int i = 0; i < sum.rows(); ++i) {
    const double factor = weight * b[i];
    if (factor == 0) continue;
    for (int j = 0; j < sum.columns(); ++j) sum(i, j) += factor * b[j];
  }
}

void drop_rounding(Matrix& m) {
  double largest = 0;
  for (int i = 0; i < m.rows(); ++i) {
    for (const double v : m.row(i)) largest = std::max(largest, std::abs(v));
  }
  for (int i = 0; i < m.rows(); ++i) {
    for (double& v : m.row(i)) v = std::abs(v) <= kZero * largest ? 0 : v;
  }
}

struct Moments {
  std::vector<Matrix> weighted;  // Int b b^T weight_k dw, one an offset
  Matrix gram;                   // their sum, as the weights sum to 1
  Matrix over_norm;              // Int b b^T / |w|_1 dw
};

template <typename Weight>
Moments moments(const Basis& basis, const std::vector<glm::ivec3>& offsets, Weight weight) {
  const Matrix zero(basis.size(), basis.size());
  Moments result{std::vector<Matrix>(offsets.size(), zero), zero, zero};
  std::vector<double> b(basis.size());
  for (const QuadratureNode& node : quadrature(basis, octants())) {
    basis.evaluate(node.w, b);
    add_outer(result.over_norm, node.weight / manhattan(node.w), b);
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      const double share = weight(offsets[k], node.w);
      if (share != 0) add_outer(result.weighted[k], node.weight * share, b);
    }
  }
  for (const Matrix& part : result.weighted) {
    for (int i = 0; i < basis.size(); ++i) {
      for (int j = 0; j < basis.size(); ++j) result.gram(i, j) += part(i, j);
    }
  }
  return result;
}

// The Gram matrix summed from the same nodes makes the operators sum to 1 however ill-conditioned it is.
OperatorTransport operators(const Moments& moments, const std::vector<glm::ivec3>& offsets) {
  OperatorTransport transport;
  for (std::size_t k = 0; k < offsets.size(); ++k) {
    const glm::dvec3 way(offsets[k]);
    Matrix weights = solve(moments.gram, moments.weighted[k]);
    drop_rounding(weights);
    transport.neighbours.push_back(
        {offsets[k], way == glm::dvec3(0) ? way : glm::normalize(way), std::move(weights)});
  }
  return transport;
}

}  // namespace

OperatorTransport make_upwind(const Basis& basis, Matrix& inverse_norm) {
  const std::vector<glm::ivec3> offsets(kAxes.begin(), kAxes.end());
  const Moments m = moments(basis, offsets, upwind_weight);
  inverse_norm = solve(m.gram, m.over_norm);
  drop_rounding(inverse_norm);
  return operators(m, offsets);
}

}  // namespace clpv
