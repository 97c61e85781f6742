// SPDX-License-Identifier: MIT
// A scene made on the spot, for benchmarks without a file: an open hall with columns, lit by the sun.
#pragma once

#include "scene/scene.hpp"

namespace clpv::bench {

/// 24 x 10 x 24 m, open above; of about `triangles` triangles, tessellated evenly (at least 132). One camera, one sun.
Scene make_hall(int triangles);

inline constexpr int kHallTriangles = 20000;

}  // namespace clpv::bench
