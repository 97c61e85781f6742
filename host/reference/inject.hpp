// SPDX-License-Identifier: MIT
// The CPU reference of kernels/inject.cl: one texel after another in double, straight from docs/method.md, 'Injection'.
#pragma once

#include "basis/basis.hpp"
#include "image/surface_image.hpp"
#include "kernels/shared/grid.h"
#include "options/stage_options.hpp"
#include "reference/volume.hpp"

namespace clpv::reference {

/// Adds the virtual point lights of `rsm` to `light`: grid.n cells, 3 channels.
void inject_light(const SurfaceImage& rsm, const ClpvGrid& grid, const Basis& basis,
                  const InjectOptions& options, Volume& light);

/// Merges what `surface` sees into `geometry`: grid.n + 1 samples a side, 1 channel. Of its pixels every `stride`-th each
/// way, the middle one of those it stands for.
void inject_geometry(const SurfaceImage& surface, const ClpvGrid& grid, const Basis& basis,
                     const InjectOptions& options, Volume& geometry, int stride = 1);

/// What `found`, seen by one more surface, leaves of `geometry`: of functions the one of more energy, of areas the larger.
void merge_geometry(const Volume& found, const Basis& basis, Blocking blocking, Volume& geometry);

/// `a` and `b` merged, but where their energies are so near each other that rounding decides: there the other one.
Volume otherwise_merged(const Volume& a, const Volume& b, const Basis& basis, Blocking blocking);

/// Where a pixel's surface is, in units of cells from the grid's origin. Light: moved half a cell off the
/// surface.
glm::dvec3 grid_point(const SurfaceImage& surface, std::size_t pixel, const ClpvGrid& grid, bool light);

}  // namespace clpv::reference
