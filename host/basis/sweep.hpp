// SPDX-License-Identifier: MIT
// Directions, links and projections of the sweep (docs/method.md, 'The sweep'): discrete ordinates
// with short characteristics. In double, without OpenCL.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"

namespace clpv {

/// One sweep direction: the mean direction of one of parts^2 parts of a bin of `bins24`.
///
/// Light along w moves from plane to plane across the axis of its largest component. A cell draws
/// from four upstream cells of the previous plane, offset by 0 or 1 along the other axes. All
/// directions of a bin share these offsets.
struct SweepDirection {
  glm::dvec3 w;                ///< unit
  double solid_angle;          ///< [sr]
  double flux;                 ///< |w_m| in (0, 1], m the bin's axis
  std::array<double, 4> taps;  ///< weights of the cells offset by 0, u, v, u and v; they sum to 1
};

/// A bin of `bins24` and its directions.
struct SweepBin {
  int axis, u, v;                    ///< axis m of the largest component; the axes of a plane
  glm::ivec3 sign;                   ///< signs of w along x, y, z
  std::array<glm::ivec3, 4> offset;  ///< offset of each tap, downstream minus upstream cell
  double solid_angle;                ///< [sr]
  std::vector<SweepDirection> directions;
};

inline constexpr int kSweepBins = 24;
inline constexpr int kMaxSweepParts = 4;

/// Returns all bins in the order of `bins24`. `parts`: 1 to kMaxSweepParts, for 24, 96, 216 or 384
/// directions.
std::vector<SweepBin> sweep_bins(int parts);

/// A bin and one of its parts^2 parts.
struct SubBin {
  int bin, part;
};
/// Returns the sub-bin that contains the unit vector w.
SubBin sub_bin_along(const glm::dvec3& w, int parts);

/// Returns the one of `coarser_parts`^2 parts of a bin that contains most of part `part` of
/// `parts`^2.
int coarser_part(int part, int parts, int coarser_parts);

/// (24 parts^2) x N: mean of each basis function over each part of a bin, in the order of
/// sweep_bins(). A row times a cell's coefficients is the light that the cell injects along the
/// part's direction, negative values included: the sum over all directions is then the exact
/// energy.
Matrix part_means(const Basis& basis, int parts);

/// Difference between a clamped cosine about n and its bands of spherical harmonics, by z = w . n:
///   max(0, z) - sum_i alpha_i(n) Y_i(w) = |z| / 2 - even[0] - even[1] z^2 - even[2] z^4
/// A cell whose light leaves about one normal injects it, too (docs/method.md, 'The sweep').
struct CosineRest {
  std::array<double, 3> even;
};
/// Returns the rest for a sweep along 24 parts^2 directions, where z is the mean over a part;
/// `means`: part_means(). even[0] is such that the sum over all directions is 0 in the mean over n,
/// so that cells keep their energy. Empty for bases that are no harmonics.
std::optional<CosineRest> cosine_rest(const Basis& basis, const Matrix& means, int parts);

/// Returns the basis of swept light: the nine spherical harmonics of bands 0 to 2. Convolution with
/// the clamped cosine leaves almost nothing beyond band 2 (Ramamoorthi and Hanrahan 2001, 'An
/// efficient representation for irradiance environment maps').
std::unique_ptr<Basis> swept_basis();

/// 9 x 24: projection of light that is constant in each bin on swept_basis().
Matrix swept_projection();

/// 24 x 24: from radiance per bin to radiance per bin after one scattering in a medium: means of
/// the phase function of Henyey and Greenstein (1941). Rows and columns sum to 1: uniform light
/// stays uniform, and no energy is lost. `anisotropy`: g in (-1, 1).
Matrix scattering_matrix(double anisotropy);

/// Multiplies the blocking weights of each link by the length of its offset to the power `power`.
/// With power 1 a full wall is opaque along diagonals too.
void close_diagonals(std::vector<SweepLink>& links, double power);

/// Returns the links from a cell's 26 neighbours in the order of kernels/steps/transmittance.cl,
/// without blocking weights.
std::vector<SweepLink> sweep_links();

/// Transmittance volumes that sweep_links.cl writes: for each axis in order, the links that
/// directions of that axis use.
struct LinkVolumes {
  std::array<std::vector<int>, 3> across;  ///< for each axis, indices into sweep_links()

  int count() const {
    return static_cast<int>(across[0].size() + across[1].size() + across[2].size());
  }
  /// Returns the index of the volume of the link with `offset` for directions of `axis`.
  int volume(int axis, const glm::ivec3& offset) const;
};
LinkVolumes link_volumes();

}  // namespace clpv
