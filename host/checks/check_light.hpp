// SPDX-License-Identifier: MIT
// Random volumes, and how those of a cascade compare: what the checks of light on its way share.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "basis/basis.hpp"
#include "checks/check.hpp"
#include "reference/volume.hpp"

namespace clpv::reference {

/// Light in a third of the cells, of any sign, as bases with negative lobes leave it.
Volume random_light(const Basis& basis, int n, std::mt19937& random);

/// `numbers` a corner, in [0, 1].
Volume random_blockers(int numbers, int n, std::mt19937& random);

/// `result`, or the greatest difference of a cascade over the largest value where that is more.
void compare_cascade(const std::vector<float>& found, const Volume& twin, std::size_t cascade,
                     CheckResult& result);

}  // namespace clpv::reference
