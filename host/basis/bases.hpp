// SPDX-License-Identifier: MIT
// Spherical radial basis functions (SRBF): Abel-Poisson kernels G at fixed centres xi_i with
// bandwidths lambda_i.
//   G(t; lambda) = (1 - lambda^2) / (1 - 2 lambda t + lambda^2)^(3/2)
//   b_i(w) = G(w . xi_i; lambda_i),  Int b_i dw = 4 pi
//   A_ij = Int b_i b_j dw = 4 pi G(xi_i . xi_j; lambda_i lambda_j)
#pragma once

#include <array>
#include <map>

#include "basis/basis.hpp"
#include "basis/clamped_cosine.hpp"
#include "basis/quadrature.hpp"

namespace clpv {

// Real spherical harmonics of bands 0 .. L-1, N = L^2, in the order l^2 + l + m; orthonormal, A =
// 1. Y_lm = K_lm (m < 0: Im, else Re) (x + iy)^|m| Q_lm(z), Q_lm = d^|m| P_l / dz^|m|; signs as in
// Y_1m = 0.4886 (y, z, x).

/// Basis of `bands`^2 real spherical harmonics.
class SphericalHarmonics : public Basis {
 public:
  explicit SphericalHarmonics(int bands);

  using Basis::evaluate;
  void evaluate(const glm::dvec3& w, std::span<double> b) const override;
  void cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const override;
  void add_literals(Literals& literals) const override;
  int bands() const override { return bands_; }

 private:
  struct Function {
    int band, order;
    std::vector<double> polynomial;  ///< K_lm Q_lm: [i] is the coefficient of z^i
  };

  int bands_;
  std::vector<Function> functions_;
};

// Direction bins: one indicator function for each of m x m regions on each of a cube's six faces
// (docs/bases.md, 'The sets'). f is constant in each bin, so coefficients of light are never
// negative.
//
// A face's region is bounded by planes through the origin, u = l_j n and v = l_j n, n the
// coordinate along the face's normal. bins24: m = 2, l = 0. bins96: m = 4, l = -c, 0, c with c =
// tan(22.5 degrees).

/// Axes of a face of kAxes: along its normal, u and v.
struct FaceAxes {
  int n, u, v;
  double sign;
};
FaceAxes axes_of(int face);

/// Region of a face between two lines along u and two along v.
SphericalPolygon face_region(int face, std::array<double, 2> u, std::array<double, 2> v);

/// Basis of 6 m^2 direction bins.
class DirectionBins : public Basis {
 public:
  /// `side`: number m of bins along each edge of a face, 2 or 4.
  explicit DirectionBins(int side);

  using Basis::evaluate;
  /// On a boundary all adjacent bins have equal shares that sum to 1, so that no axis is preferred.
  void evaluate(const glm::dvec3& w, std::span<double> b) const override;
  /// Sums 96 patches: exact for patches that the horizon of d does not cross; for others w . d is
  /// taken as uniform over the patch's width. Scaled to the exact sum pi. The error is at most 1 %
  /// (bins24) or 3.3 % (bins96) of the mean pi / N.
  void cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const override;
  void add_literals(Literals& literals) const override;
  std::vector<glm::dvec3> creases() const override;

 private:
  struct Patch {
    int bin;
    glm::dvec3 area;  ///< Int w dw
    double width;  ///< width times solid angle; the horizon crosses the patch if |area . d| < width
                   ///< / 2
  };
  void add_patch(int bin, const SphericalPolygon& polygon);

  int side_;
  std::vector<double> lines_;  ///< l_j, side - 1 numbers
  std::vector<Patch> patches_;
};

/// Returns G(t; lambda) for t in [-1, 1], lambda in (0, 1).
double abel_poisson(double t, double lambda);

/// Basis of SRBFs.
class Srbf : public Basis {
 public:
  /// Unit centres and one lambda per centre. Throws like make_basis_from_centres().
  Srbf(const std::string& name, const std::vector<glm::dvec3>& centres,
       const std::vector<double>& lambdas);

  using Basis::evaluate;
  void evaluate(const glm::dvec3& w, std::span<double> b) const override;
  void cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const override;
  void add_literals(Literals& literals) const override;

 private:
  std::map<double, CosineOfPoisson> cosines_;  ///< by lambda
};

/// A named set of unit centres.
struct SrbfSet {
  std::string name;
  std::vector<glm::dvec3> centres;
};

/// Returns the named sets: srbf4, srbf6, srbf8v1, srbf8v2, srbf8v3, srbf14.
const std::vector<SrbfSet>& srbf_sets();

}  // namespace clpv
