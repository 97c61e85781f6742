// SPDX-License-Identifier: MIT
// What gathering evaluates: irradiance as few functions of a surface's normal, times a matrix. In double; knows no OpenCL.
#pragma once

#include <memory>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"

namespace clpv {

/// E(n) = g(n) . M c / s^2 [W/m^2] from a cell's coefficients c, with
///   g(n) = (1 - window) f(-n) + window mean,   mean = that of f over all directions.
///
/// Face transports: f = b, M = 4 (docs/method.md, 'Gathering'). Operators: f = alpha, M = K (Transport::gather), or,
/// for bases of more functions than nine, f = the nine spherical harmonics of bands 0 to 2 and M the projection of
/// alpha(-n) K on them: a convolution with the clamped cosine leaves almost nothing beyond band 2 (Ramamoorthi & Hanrahan
/// 2001, 'An efficient representation for irradiance environment maps').
///
/// Operators gather every lobe in a cell at once, those that leave the surface too, and what a truncated basis makes of
/// the latter is negative light that eats the other's. The window is the least that leaves no clamped cosine lobe a
/// negative irradiance on any surface; 0 for face transports, and for swept light: a lobe that went through the 24 bins of a
/// sweep is too wide to leave any.
class GatherForm {
 public:
  /// Refers to `basis`.
  GatherForm(const Basis& basis, const Transport& transport);

  const Basis& functions() const { return harmonics_ ? *harmonics_ : *basis_; }
  bool integrates() const { return integrates_; }  ///< f are integrals over the clamped cosine, not values
  bool projects() const { return harmonics_ != nullptr; }  ///< f are not of the basis
  const Matrix& matrix() const { return matrix_; }
  double window() const { return window_; }
  const std::vector<double>& mean() const { return mean_; }

  /// f(w), one a row of the matrix.
  std::vector<double> evaluate(const glm::dvec3& w) const;
  /// g(n) from f(-n).
  std::vector<double> windowed(std::vector<double> f) const;

 private:
  double least_window() const;

  const Basis* basis_;
  std::shared_ptr<const Basis> harmonics_;  ///< of the projection
  bool integrates_ = false;
  Matrix matrix_;
  double window_ = 0;
  std::vector<double> mean_;
};

}  // namespace clpv
