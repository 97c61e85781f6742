// SPDX-License-Identifier: MIT
// Directions that light is swept along, once through the grid each (docs/method.md, 'The sweep'). In double; knows no
// OpenCL.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "basis/basis.hpp"
#include "basis/transport.hpp"

namespace clpv {

/// Discrete ordinates: the 24 bins of `bins24` in parts^2 parts each, and the mean direction of each part.
///
/// Light along w moves from plane to plane across the axis of its largest component. A cell draws from the four cells of
/// the plane before, 0 or 1 cells aside along each other axis, against w: its taps sum to 1. Each direction's bin has
/// these offsets in common.
struct SweepDirection {
  glm::dvec3 w;        ///< unit
  double solid_angle;  ///< [sr]
  double flux;         ///< of w along its axis, in (0, 1]: a plane's distance over the way between planes
  std::array<double, 4> taps;  ///< of the cells 0, u, v, u and v aside
};

struct SweepBin {
  int axis, u, v;                    ///< the largest component's axis; the two that a plane spans
  glm::ivec3 sign;                   ///< of w along x, y, z
  std::array<glm::ivec3, 4> offset;  ///< how far light of each tap has come, in cells
  double solid_angle;                ///< [sr]
  std::vector<SweepDirection> directions;
};

inline constexpr int kSweepBins = 24;
inline constexpr int kMostSweepParts = 4;

/// Bins in the order of `bins24`. `parts`: 1 to kMostSweepParts, for 24, 96, 216 or 384 directions.
std::vector<SweepBin> sweep_bins(int parts);

/// The bin that a unit vector w lies in, and which of its parts^2 parts.
struct BinPart {
  int bin, part;
};
BinPart part_along(const glm::dvec3& w, int parts);

/// Which of `coarser_parts`^2 parts of a bin a part of `parts`^2 lies in, or mostly.
int coarser_part(int part, int parts, int coarser_parts);

/// 24 x N: the mean over each bin of the functions of a basis. What a basis holds is swept as these means, negative ones
/// too: the energy of any field is kept.
Matrix bin_means(const Basis& basis);

/// Whether a basis's coefficients are these means already: bins24's.
bool holds_bin_means(const Basis& basis);

/// What is kept of swept light: the nine spherical harmonics of bands 0 to 2, all that gathering asks of it: a convolution with the
/// clamped cosine leaves almost nothing beyond band 2 (Ramamoorthi & Hanrahan 2001, 'An efficient representation for
/// irradiance environment maps').
std::unique_ptr<Basis> swept_basis();

/// 9 x 24: the projection on them of light that is the same all over each bin.
Matrix swept_projection();

/// What blocks along diagonal links grows by their length to that power: by 1 a wall that fills its faces lets nothing through.
void close_diagonals(std::vector<SweepLink>& links, double power);

/// The links from a cell's 26 neighbours, as kernels/transmittance.cl numbers them.
std::vector<SweepLink> sweep_links();

/// Volumes of the transmittance of links that sweep_links.cl writes: for each axis, x's first, those that directions across it use.
struct LinkVolumes {
  std::array<std::vector<int>, 3> across;  ///< numbers of sweep_links()

  int count() const { return static_cast<int>(across[0].size() + across[1].size() + across[2].size()); }
  /// The number of the volume that holds the link from `offset` for directions across `axis`.
  int volume(int axis, const glm::ivec3& offset) const;
};
LinkVolumes link_volumes();

}  // namespace clpv
