// SPDX-License-Identifier: MIT
#include "pipeline/voxels/blockers.hpp"

#include "codegen/linear_code.hpp"
#include "kernels/shared/blockers.h"

namespace clpv {
namespace {

constexpr unsigned kMaxBlockers = 1u << 20;  // per launch

VoxelMaskShape shape_of(int grid, int cascades) {
  return {grid + 1, grid + 1, CLPV_BLOCKER_WORDS, static_cast<std::size_t>(cascades)};
}

ProgramSource triangles_program(const SceneBuffers& scene, int grid) {
  ProgramSource source{"voxels/blockers.cl", {}, {}};
  source.literals.integer("CLPV_GRID", grid).flag("CLPV_MASKED", scene.masked);
  return source;
}

ProgramSource shares_program(int grid, const VolumeFormat& format) {
  ProgramSource source{"voxels/blocked_areas.cl", {}, coefficient_macros(3)};
  source.literals.integer("CLPV_GRID", grid);
  add_format_literals(source.literals, format);
  return source;
}

}  // namespace

BlockerVoxelizer::BlockerVoxelizer(Session& session, const SceneBuffers& scene, int grid, int cascades,
                                   const VolumeFormat& format)
    : scene_(scene),
      grid_(grid),
      masks_(session, scene, shape_of(grid, cascades), kMaxBlockers, "masks of triangles that block"),
      triangles_(session, triangles_program(scene, grid), "voxelize_blockers"),
      shares_(session, shares_program(grid, format), "blocked_areas") {}

void BlockerVoxelizer::voxelize(std::size_t cascade, const ClpvGrid& grid, Volume& geometry) {
  masks_.update(cascade, grid, triangles_, scene_.textures, scene_.texels, masks_.buffer(),
                masks_.slot(cascade));
  shares_.set(masks_.buffer(), masks_.slot(cascade), geometry.memory());
  const auto corners = static_cast<std::size_t>(grid_) + 1;
  shares_.launch(cl::NDRange(corners, corners, corners), cl::NDRange(kMaskGroup, 1, 1));
}

}  // namespace clpv
