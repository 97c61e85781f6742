// SPDX-License-Identifier: MIT
#include "basis/matrix.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/error.hpp"

namespace clpv {
namespace {

// Gram matrices reach condition numbers of 1e7: the wider type keeps A^-1 A = 1 to 1e-9 there.
using Wide = long double;

// Lower triangle L of A = L L^T, row by row.
std::vector<Wide> cholesky(const Matrix& a) {
  const int n = a.rows();
  std::vector<Wide> lower(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), 0);
  const auto at = [&](int i, int j) -> Wide& { return lower[static_cast<std::size_t>(i) * n + j]; };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j <= i; ++j) {
      Wide sum = a(i, j);
      for (int k = 0; k < j; ++k) sum -= at(i, k) * at(j, k);
      if (i != j) {
        at(i, j) = sum / at(j, j);
      } else if (sum > 0) {
        at(i, i) = std::sqrt(sum);
      } else {
        throw Error(ExitCode::run_time, "matrix is not positive definite (pivot {} is {})", i,
                    static_cast<double>(sum));
      }
    }
  }
  return lower;
}

// One Jacobi rotation that makes a(p, q) vanish.
void rotate(Matrix& a, int p, int q) {
  if (a(p, q) == 0) return;
  const double theta = (a(q, q) - a(p, p)) / (2 * a(p, q));
  const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
  const double c = 1 / std::hypot(t, 1.0), s = t * c;
  for (int k = 0; k < a.rows(); ++k) {
    const double kp = a(k, p), kq = a(k, q);
    a(k, p) = c * kp - s * kq;
    a(k, q) = s * kp + c * kq;
  }
  for (int k = 0; k < a.rows(); ++k) {
    const double pk = a(p, k), qk = a(q, k);
    a(p, k) = c * pk - s * qk;
    a(q, k) = s * pk + c * qk;
  }
}

double largest_off_diagonal(const Matrix& a) {
  double largest = 0;
  for (int i = 0; i < a.rows(); ++i) {
    for (int j = 0; j < i; ++j) largest = std::max(largest, std::abs(a(i, j)));
  }
  return largest;
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
  std::vector<double> r(static_cast<std::size_t>(rows_), 0.0);
  for (int i = 0; i < rows_; ++i) {
    for (int j = 0; j < columns_; ++j) {
      r[static_cast<std::size_t>(i)] += (*this)(i, j) * vector[static_cast<std::size_t>(j)];
    }
  }
  return r;
}

Matrix Matrix::transposed() const {
  Matrix r(columns_, rows_);
  for (int i = 0; i < rows_; ++i) {
    for (int j = 0; j < columns_; ++j) r(j, i) = (*this)(i, j);
  }
  return r;
}

Matrix solve(const Matrix& a, const Matrix& b) {
  const int n = a.rows();
  const std::vector<Wide> lower = cholesky(a);
  const auto l = [&](int i, int j) { return lower[static_cast<std::size_t>(i) * n + j]; };
  Matrix r(n, b.columns());
  std::vector<Wide> x(static_cast<std::size_t>(n));
  for (int column = 0; column < b.columns(); ++column) {
    for (int i = 0; i < n; ++i) {
      Wide sum = b(i, column);
      for (int k = 0; k < i; ++k) sum -= l(i, k) * x[static_cast<std::size_t>(k)];
      x[static_cast<std::size_t>(i)] = sum / l(i, i);
    }
    for (int i = n - 1; i >= 0; --i) {
      Wide sum = x[static_cast<std::size_t>(i)];
      for (int k = i + 1; k < n; ++k) sum -= l(k, i) * x[static_cast<std::size_t>(k)];
      x[static_cast<std::size_t>(i)] = sum / l(i, i);
    }
    for (int i = 0; i < n; ++i) r(i, column) = static_cast<double>(x[static_cast<std::size_t>(i)]);
  }
  return r;
}

Matrix inverse(const Matrix& a) {
  return solve(a, Matrix::identity(a.rows()));
}

double condition_number(const Matrix& a) {
  Matrix d = a;
  const int n = d.rows();
  double scale = 0;
  for (int i = 0; i < n; ++i) scale = std::max(scale, std::abs(d(i, i)));
  // Jacobi converges quadratically: a dozen sweeps serve any matrix of this size.
  constexpr int kSweeps = 30;
  for (int sweep = 0; sweep < kSweeps && largest_off_diagonal(d) > 1e-16 * scale; ++sweep) {
    for (int p = 0; p < n; ++p) {
      for (int q = p + 1; q < n; ++q) rotate(d, p, q);
    }
  }
  double least = std::numeric_limits<double>::infinity(), greatest = 0;
  for (int i = 0; i < n; ++i) {
    least = std::min(least, d(i, i));
    greatest = std::max(greatest, d(i, i));
  }
  return least > 0 ? greatest / least : std::numeric_limits<double>::infinity();
}

}  // namespace clpv
