// SPDX-License-Identifier: MIT
// In place of rasterize_gl.cpp where EGL or OpenGL ES is not there to build it with.
#ifndef CLPV_BENCH_GL

#include "bench/baseline/rasterize_gl.hpp"
#include "support/error.hpp"

namespace clpv::bench {

struct GlRasterizer::Impl {};

std::string gl_missing() {
  return "built without EGL and OpenGL ES (CLPV_BENCH_GL; Debian: libegl-dev libgles-dev libgl1-mesa-dri)";
}

GlRasterizer::GlRasterizer(const Scene&, Pass, std::vector<ClpvView>, const ClpvLight&) {
  throw Error(ExitCode::device, "{}", gl_missing());
}
GlRasterizer::~GlRasterizer() = default;
void GlRasterizer::draw() {}
std::vector<std::vector<float>> GlRasterizer::depths() {
  return {};
}

}  // namespace clpv::bench

#endif
