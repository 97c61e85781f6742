// SPDX-License-Identifier: MIT
#include "pipeline/voxels/reflectors.hpp"

#include "basis/bounce.hpp"
#include "codegen/linear_code.hpp"
#include "kernels/shared/reflectors.h"

namespace clpv {
namespace {

static_assert(kCellFaces == CLPV_CELL_FACES);

constexpr unsigned kMaxReflectors = 1u << 18;  // per launch

VoxelMaskShape shape_of(int grid) {
  return {grid, grid, CLPV_CELL_FACES * CLPV_FACE_WORDS, 1};
}

ProgramSource reflect_program(const SceneBuffers& scene, int grid) {
  ProgramSource source{"voxels/reflectors.cl", {}, {}};
  source.literals.integer("CLPV_GRID", grid)
      .flag("CLPV_MASKED", scene.masked)
      .flag("CLPV_TEXTURED", scene.textured)
      .flag("CLPV_COLOURED", scene.coloured);
  return source;
}

ProgramSource reflect_shares_program(int grid, const VolumeFormat& format) {
  ProgramSource source{"voxels/face_albedo.cl", {}, coefficient_macros(kCellFaces)};
  source.literals.integer("CLPV_GRID", grid).real("CLPV_EDGE_LOSS", edge_loss());
  add_format_literals(source.literals, format);
  return source;
}

}  // namespace

ReflectorVoxelizer::ReflectorVoxelizer(Session& session, const SceneBuffers& scene, int grid, int cascades,
                                       const VolumeFormat& format)
    : scene_(scene),
      grid_(grid),
      sides_(session, scene, shape_of(grid), kMaxReflectors, "sides of triangles that reflect"),
      triangles_(session, reflect_program(scene, grid), "voxelize_reflectors"),
      shares_(session, reflect_shares_program(grid, format), "face_albedo") {
  for (int c = 0; c < cascades; ++c) {
    reflectors_.push_back(
        std::make_unique<Volume>(session, VolumeShape{grid, kCellFaces, 3}, "reflectors", format));
  }
}

void ReflectorVoxelizer::voxelize(std::size_t cascade, const ClpvGrid& grid) {
  sides_.update(cascade, grid, triangles_, scene_.textures, scene_.texels, sides_.buffer());
  shares_.set(sides_.buffer(), reflectors_[cascade]->memory());
  const std::size_t cells = grid_;
  shares_.launch(cl::NDRange(cells, cells, cells), cl::NDRange(kMaskGroup, 1, 1));
}

}  // namespace clpv
