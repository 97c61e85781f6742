// SPDX-License-Identifier: MIT
#include "pipeline/voxels/visibility.hpp"

namespace clpv {
namespace {

constexpr unsigned kMaxOccluders = 1u << 20;  // per launch
constexpr std::size_t kPoints = 64;           // points per cube between cell centres, one byte each

ProgramSource program_of(int grid) {
  ProgramSource source{"voxels/visibility.cl", {}, {}};
  source.literals.integer("CLPV_GRID", grid);
  return source;
}

/// One cube between centres for each cell except the last ones.
VoxelMaskShape occlusion_shape(int grid, int cascades) {
  return {grid, grid - 1, kPoints / sizeof(cl_uint), static_cast<std::size_t>(cascades)};
}

}  // namespace

std::size_t CellVisibility::bytes(int grid) {
  return occlusion_shape(grid, 1).bytes();
}

CellVisibility::CellVisibility(Session& session, const SceneBuffers& scene, int grid, int cascades)
    : occluded_(session, scene, occlusion_shape(grid, cascades), kMaxOccluders,
                "cells occluded by triangles"),
      triangles_(session, program_of(grid), "occlude_cells") {}

void CellVisibility::update(std::size_t cascade, const ClpvGrid& grid) {
  occluded_.update(cascade, grid, triangles_, occluded_.buffer(), occluded_.slot(cascade));
}

}  // namespace clpv
