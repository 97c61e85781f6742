// SPDX-License-Identifier: MIT
// Suites that time clpv beside the same work by other means.
#pragma once

#include "bench/suites.hpp"

namespace clpv::bench {

/// Propagation of sh2 beside C++ with OpenMP and AVX2.
Suite native_suite();

/// Draws the task by OpenGL ES (rasterize_gl.hpp), for rasterize_suite({"opengl", ...}).
Job rasterize_gl_job(RasterTask task);

}  // namespace clpv::bench
