// SPDX-License-Identifier: MIT
// Direction bins: the cube's six faces, each cut into m x m regions, and one indicator function a region.
// f is constant in each bin: nothing is ever negative and the transport operators are diagonal.
//
// A face's region is bounded by planes through the origin, u = l_j n and v = l_j n, n the coordinate along
// the face's normal. bins24: m = 2, l = 0. bins96: m = 4, l = -c, 0, c with c = tan(22.5 degrees).
#pragma once

#include <array>

#include "basis/basis.hpp"
#include "basis/quadrature.hpp"

namespace clpv {

/// The axes along the normal of a face of kAxes, and along its u and v.
struct FaceAxes {
  int n, u, v;
  double sign;
};
FaceAxes axes_of(int face);

/// What of a face lies between two lines along u and two along v.
SphericalPolygon face_region(int face, std::array<double, 2> u, std::array<double, 2> v);

class DirectionBins : public Basis {
 public:
  /// `side`: bins along each edge of a face, 2 or 4.
  explicit DirectionBins(int side);

  using Basis::evaluate;
  /// On a boundary each of the bins that meet there has an equal share, so that axes treat them alike.
  void evaluate(const glm::dvec3& w, std::span<double> b) const override;
  /// By 96 patches: exact for those that the horizon of d does not cross; a crossed one counts as if w . d
  /// were spread evenly over its width. Scaled to the exact sum pi. Off by at most 1 % (bins24) and 3.3 %
  /// (bins96) of the mean pi / N.
  void cosine_integrals(const glm::dvec3& d, std::span<double> alpha) const override;
  std::string kernel_source() const override;
  std::vector<glm::dvec3> creases() const override;

 private:
  struct Patch {
    int bin;
    glm::dvec3 area;  ///< Int w dw
    double width;  ///< of the patch, times its solid angle: it straddles the horizon where |area . d| < width
                   ///< / 2
  };
  void add_patch(int bin, const SphericalPolygon& polygon);
  std::string kernel_basis() const;
  std::string kernel_cosine() const;

  int side_;
  std::vector<double> lines_;  ///< l_j, side - 1 of them
  std::vector<Patch> patches_;
};

}  // namespace clpv
