// SPDX-License-Identifier: MIT
#include "pipeline/reflect.hpp"

#include <algorithm>

#include "basis/bounce.hpp"
#include "codegen/cell_macros.hpp"
#include "kernels/shared/reflect.h"

namespace clpv {
namespace {

static_assert(kReflectingSides == CLPV_SIDES);

constexpr std::size_t kGroup = 64;
// Triangles a launch: a device that watches over its display ends what takes seconds.
constexpr unsigned kMostTriangles = 1u << 18;

ProgramSource triangles_program(const SceneBuffers& scene, int grid) {
  ProgramSource source{"reflect.cl", {}, {}};
  source.literals.integer("CLPV_GRID", grid)
      .flag("CLPV_MASKED", scene.masked)
      .flag("CLPV_TEXTURED", scene.textured)
      .flag("CLPV_COLOURED", scene.coloured);
  return source;
}

ProgramSource shares_program(int grid, const VolumeFormat& format) {
  ProgramSource source{"reflect_shares.cl", {}, coefficient_macros(kReflectingSides)};
  source.literals.integer("CLPV_GRID", grid).real("CLPV_EDGE_LOSS", edge_loss());
  add_format_literals(source.literals, format);
  return source;
}

}  // namespace

std::size_t SceneReflector::bytes(int grid) {
  const auto cells = static_cast<std::size_t>(grid);
  return cells * cells * cells * CLPV_SIDES * CLPV_SIDE_WORDS * sizeof(cl_uint);
}

SceneReflector::SceneReflector(Session& session, const SceneBuffers& scene, int grid, int cascades,
                               const VolumeFormat& format)
    : session_(session),
      scene_(scene),
      grid_(grid),
      sides_(session.buffer(bytes(grid), "sides of triangles that reflect")),
      triangles_(session, triangles_program(scene, grid), "reflect_triangles"),
      shares_(session, shares_program(grid, format), "reflect_shares") {
  for (int c = 0; c < cascades; ++c) {
    reflectors_.push_back(
        std::make_unique<Volume>(session, VolumeShape{grid, kReflectingSides, 3}, "reflectors", format));
  }
}

void SceneReflector::reflect(std::size_t cascade, const ClpvGrid& grid) {
  session_.fill_zero(sides_, bytes(grid_));
  for (unsigned first = 0; first < scene_.triangle_count; first += kMostTriangles) {
    const cl_uint count = std::min(scene_.triangle_count - first, kMostTriangles);
    triangles_.set(grid, cl_uint{first}, count, scene_.vertices, scene_.triangles, scene_.materials,
                   scene_.textures, scene_.texels, sides_);
    triangles_.launch(cl::NDRange(count), cl::NDRange(kGroup));
  }
  shares_.set(sides_, reflectors_[cascade]->memory());
  const auto cells = static_cast<std::size_t>(grid_);
  shares_.launch(cl::NDRange(cells, cells, cells), cl::NDRange(kGroup, 1, 1));
}

}  // namespace clpv
