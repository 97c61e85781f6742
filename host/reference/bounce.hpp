// SPDX-License-Identifier: MIT
// CPU reference of stage `bounce` (kernels/sweep/bounce.cl), in double: light reflected by surfaces
// before the last sweep (docs/method.md, 'More bounces').
#pragma once

#include <vector>

#include "options/choices.hpp"
#include "reference/sweep.hpp"

namespace clpv::reference {

/// Series S of all further bounces inside one cascade: flux that a face, and the faces that its
/// light meets, reflect of 1 W of incident flux.
Volume bounce_series(const Basis& basis, const Transport& transport, const SweptCascade& cascade,
                     const Volume& reflectors);

/// Sources of the sweep in every cascade, in `basis` [W/sr]: injected light and the light that
/// `reflectors`, one volume per cascade, reflect.
std::vector<Volume> bounce(const Basis& basis, const Transport& transport,
                           std::vector<SweptCascade> cascades,
                           const std::vector<const Volume*>& reflectors, Bounces bounces);

/// Sweeps the result of bounce().
std::vector<Volume> sweep_bounced(const Basis& basis, const Transport& transport,
                                  std::vector<SweptCascade> cascades,
                                  const std::vector<const Volume*>& reflectors, Bounces bounces);

}  // namespace clpv::reference
