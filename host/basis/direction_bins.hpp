// SPDX-License-Identifier: MIT
// Direction bins: one indicator function for each of m x m regions on each of a cube's six faces
// (docs/bases.md, 'The sets'). f is constant in each bin, so coefficients of light are never
// negative.
//
// A face's region is bounded by planes through the origin, u = l_j n and v = l_j n, n the
// coordinate along the face's normal. bins24: m = 2, l = 0. bins96: m = 4, l = -c, 0, c with c =
// tan(22.5 degrees).
#pragma once

#include <array>

#include "basis/basis.hpp"
#include "basis/quadrature.hpp"

namespace clpv {

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

}  // namespace clpv
