// SPDX-License-Identifier: MIT
// CPU reference of stage `bounce` (kernels/sweep/bounce.cl), in double: light reflected by surfaces
// before the last sweep (docs/method.md, 'More bounces').
#pragma once

#include <vector>

#include "basis/bounce.hpp"
#include "options/choices.hpp"
#include "reference/sweep.hpp"

namespace clpv::reference {

/// Light of the white furnace in bins24, as radiance: the faces of `white` (reflector_masks), one
/// volume per cascade, and the border emit radiance 1; of the border's, what walls let through does
/// not count (kLeastOpen).
std::vector<Volume> furnace(const Basis& basis, const Transport& transport,
                            std::vector<SweptCascade> cascades,
                            const std::vector<const Volume*>& white,
                            double most_white = kNoLimitOfWhite);

/// Reflectors over their own furnace's incident flux, as sweeps for `bounces` use them; coarser
/// cascades have `white` where their last sweep enters.
std::vector<Volume> normalised_reflectors(const Basis& basis, const Transport& transport,
                                          const std::vector<SweptCascade>& cascades,
                                          const std::vector<const Volume*>& white,
                                          const std::vector<const Volume*>& reflectors,
                                          Bounces bounces, double most_white = kNoLimitOfWhite);

/// All further bounces inside one cascade. `all`: the series S, flux that a face, and the faces
/// that its light meets, reflect of 1 W of incident flux; `first`: E, in place of R in the
/// first reflection.
struct BounceSeries {
  Volume all, first;
};
BounceSeries bounce_series(const Basis& basis, const Transport& transport,
                           const SweptCascade& cascade, const Volume& reflectors);

/// Sources of the sweep in every cascade, in `basis` [W/sr]: injected light and the light that
/// `reflectors`, normalised and one volume per cascade, reflect.
std::vector<Volume> bounce(const Basis& basis, const Transport& transport,
                           std::vector<SweptCascade> cascades,
                           const std::vector<const Volume*>& reflectors, Bounces bounces,
                           int sweeps = kSeriesSweeps);

/// Sweeps the result of bounce().
std::vector<Volume> sweep_bounced(const Basis& basis, const Transport& transport,
                                  std::vector<SweptCascade> cascades,
                                  const std::vector<const Volume*>& reflectors, Bounces bounces,
                                  int sweeps = kSeriesSweeps);

}  // namespace clpv::reference
