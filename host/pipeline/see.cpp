// SPDX-License-Identifier: MIT
#include "pipeline/see.hpp"

#include <algorithm>

namespace clpv {
namespace {

constexpr std::size_t kGroup = 64;
// Triangles a launch: a device that watches over its display ends what takes seconds.
constexpr unsigned kMostTriangles = 1u << 20;
constexpr std::size_t kPoints = 64;  // of a cube between centres, a byte each

ProgramSource program_of(int grid) {
  ProgramSource source{"see.cl", {}, {}};
  source.literals.integer("CLPV_GRID", grid);
  return source;
}

}  // namespace

std::size_t SceneSight::bytes(int grid) {
  const auto cells = static_cast<std::size_t>(grid);
  return cells * cells * cells * kPoints;
}

SceneSight::SceneSight(Session& session, const SceneBuffers& scene, int grid, int cascades)
    : session_(session),
      scene_(scene),
      grid_(grid),
      hidden_(session.buffer(static_cast<std::size_t>(cascades) * bytes(grid), "cells hidden by triangles")),
      triangles_(session, program_of(grid), "see_triangles") {}

void SceneSight::see(std::size_t cascade, const ClpvGrid& grid) {
  const std::size_t from = cascade * bytes(grid_);
  session_.fill_zero(hidden_, bytes(grid_), from);
  for (unsigned first = 0; first < scene_.triangle_count; first += kMostTriangles) {
    const cl_uint count = std::min(scene_.triangle_count - first, kMostTriangles);
    triangles_.set(grid, cl_uint{first}, count, scene_.vertices, scene_.triangles, scene_.materials, hidden_,
                   static_cast<cl_uint>(cascade));
    triangles_.launch(cl::NDRange(count), cl::NDRange(kGroup));
  }
}

}  // namespace clpv
