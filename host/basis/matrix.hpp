// SPDX-License-Identifier: MIT
// A small dense matrix in double, in row-major order.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace clpv {

/// Dense matrix; zero after construction.
class Matrix {
 public:
  Matrix() = default;
  Matrix(int rows, int columns)
      : rows_(rows),
        columns_(columns),
        values_(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns), 0.0) {}
  static Matrix identity(int n);

  int rows() const { return rows_; }
  int columns() const { return columns_; }
  double& operator()(int row, int column) { return values_[index(row, column)]; }
  double operator()(int row, int column) const { return values_[index(row, column)]; }
  std::span<const double> row(int r) const {
    return {values_.data() + index(r, 0), static_cast<std::size_t>(columns_)};
  }
  std::span<double> row(int r) {
    return {values_.data() + index(r, 0), static_cast<std::size_t>(columns_)};
  }

  Matrix operator*(const Matrix& other) const;  ///< requires columns() == other.rows()
  std::vector<double> operator*(std::span<const double> vector) const;

 private:
  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(column);
  }
  int rows_ = 0, columns_ = 0;
  std::vector<double> values_;
};

Matrix transposed(const Matrix& matrix);

/// Returns sum_i a_i b_i over the elements of `a`; `b` has at least as many.
double dot(std::span<const double> a, std::span<const double> b);

/// Returns the inverse of a symmetric positive definite matrix, computed in extended precision.
/// Throws Error(run_time) if `a` is not positive definite.
Matrix inverse(const Matrix& a);
/// Returns the ratio of the largest to the smallest eigenvalue of a symmetric positive definite
/// matrix.
double condition_number(const Matrix& a);

}  // namespace clpv
