// SPDX-License-Identifier: MIT
// Generated scene for benchmarks without a file: an open hall with columns, lit by the sun.
#pragma once

#include "scene/scene.hpp"

namespace clpv::bench {

/// Makes a hall of 24 x 10 x 24 m without a roof, with one camera and one sun. Its evenly
/// tessellated boxes have about `triangles` triangles, at least 132.
SceneData make_hall(int triangles);

inline constexpr int kHallTriangles = 20000;

}  // namespace clpv::bench
