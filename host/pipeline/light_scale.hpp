// SPDX-License-Identifier: MIT
// What light is multiplied by while volumes hold it.
#pragma once

#include <vector>

#include "kernels/shared/light.h"
#include "volume/volume_format.hpp"

namespace clpv {

/// A power of two; 1 for floats. Numbers of 16 bits end at 65504, lose digits below 6e-5, and lights may be given in lux:
/// scaled, a cell of `coarsest_cell` [m] that holds all that the brightest light can send it has some 256 W/sr. Finer
/// cascades hold a quarter each; what steps add stays below the end, and a million times less still has its digits.
/// `other`: the most that all else sends through such a cell [W] (most_emitted).
float light_scale(const VolumeFormat& format, const std::vector<ClpvLight>& lights, float coarsest_cell,
                  double other = 0);

/// The light, so many times as bright.
ClpvLight scaled(ClpvLight light, float scale);

}  // namespace clpv
