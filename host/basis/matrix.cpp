// SPDX-License-Identifier: MIT
#include "basis/matrix.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "support/error.hpp"
#include "support/literals.hpp"

namespace clpv {
namespace {

// Extended precision: A^-1 A = 1 to 1e-9 at condition number 1e7, the largest of Gram matrices.
using Wide = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;

Wide widened(const Matrix& m) {
  return Wide::NullaryExpr(m.rows(), m.columns(), [&](Eigen::Index i, Eigen::Index j) {
    return static_cast<long double>(m(static_cast<int>(i), static_cast<int>(j)));
  });
}

}  // namespace

Matrix Matrix::identity(int n) {
  Matrix r(n, n);
  for (int i = 0; i < n; ++i) r(i, i) = 1;
  return r;
}

Matrix Matrix::operator*(const Matrix& other) const {
  Matrix r(rows_, other.columns_);
  for (int i = 0; i < rows_; ++i) {
    for (int k = 0; k < columns_; ++k) {
      const double factor = (*this)(i, k);
      if (factor == 0) continue;
      for (int j = 0; j < other.columns_; ++j) r(i, j) += factor * other(k, j);
    }
  }
  return r;
}

std::vector<double> Matrix::operator*(std::span<const double> vector) const {
  std::vector<double> r;
  for (int i = 0; i < rows_; ++i) r.push_back(dot(row(i), vector));
  return r;
}

double dot(std::span<const double> a, std::span<const double> b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

Matrix inverse(const Matrix& a) {
  const Eigen::LLT<Wide> cholesky(widened(a));
  if (cholesky.info() != Eigen::Success) {
    throw Error(ExitCode::run_time, "a matrix of {} rows is not positive definite", a.rows());
  }
  const Wide x = cholesky.solve(Wide::Identity(a.rows(), a.rows()));
  Matrix r(a.rows(), a.rows());
  for (int i = 0; i < r.rows(); ++i) {
    for (int j = 0; j < r.columns(); ++j) r(i, j) = static_cast<double>(x(i, j));
  }
  return r;
}

double condition_number(const Matrix& a) {
  const Eigen::SelfAdjointEigenSolver<Wide> solver(widened(a), Eigen::EigenvaluesOnly);
  const auto& ascending = solver.eigenvalues();
  const auto smallest = static_cast<double>(ascending(0)),
             largest = static_cast<double>(ascending(a.rows() - 1));
  return smallest > 0 ? largest / smallest : std::numeric_limits<double>::infinity();
}

Matrix transposed(const Matrix& matrix) {
  Matrix result(matrix.columns(), matrix.rows());
  for (int r = 0; r < matrix.rows(); ++r) {
    for (int c = 0; c < matrix.columns(); ++c) result(c, r) = matrix(r, c);
  }
  return result;
}

}  // namespace clpv
