// SPDX-License-Identifier: MIT
// Stage `bounce` in double: the CPU reference of kernels/bounce.cl (docs/method.md, 'More bounces').
#pragma once

#include <vector>

#include "options/choices.hpp"
#include "reference/sweep.hpp"

namespace clpv::reference {

/// Of one cascade by itself: what `reflectors` send back, and all that is sent back of that in kFurtherBounces bounces.
Volume reflectors_in_all(const Transport& transport, const SweptCascade& cascade, const Volume& reflectors);

/// Light to sweep of every cascade, of bins24 [W/sr]: what is injected, and what `reflectors` (reflect.hpp), one a cascade,
/// send back of it. Of all bounces finer cascades take what falls on their surfaces from the next coarser one.
std::vector<Volume> bounce(const Basis& basis, const Transport& transport, std::vector<SweptCascade> cascades,
                           const std::vector<const Volume*>& reflectors, Bounces bounces);

/// sweep() of bounce().
std::vector<Volume> sweep_bounced(const Basis& basis, const Transport& transport,
                                  std::vector<SweptCascade> cascades,
                                  const std::vector<const Volume*>& reflectors, Bounces bounces);

}  // namespace clpv::reference
