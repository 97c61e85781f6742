// SPDX-License-Identifier: MIT
// How steady light is while a camera moves: its change on surfaces that stay where they are, from one frame to the next.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "image/surface_image.hpp"

namespace clpv {

/// Of each pixel of `earlier`, whether `later` sees the same surface at the same place: the pixel of `later` that its point
/// falls on shows a surface of like normal, in whose plane the point lies and no further off than pixels stand apart. What has
/// moved, is hidden, out of view or at an edge is not.
std::vector<bool> still_seen(const SurfaceImage& earlier, const SurfaceImage& later);

/// How light changed at points.
struct LightChange {
  std::size_t points = 0;
  /// Sum of all points' |after - before| over that of `before`, all channels; none without points or without light.
  std::optional<double> mean;
  /// What 95 % of the points keep to: a point's sum over channels, over the mean point's of `before`.
  std::optional<double> p95;
};

/// Of irradiance at the same points before and after, four numbers each: red, green, blue and one that does not count.
/// `counted`: whether a point does.
LightChange change_of_light(const std::vector<bool>& counted, const std::vector<float>& before,
                            const std::vector<float>& after);

}  // namespace clpv
