// SPDX-License-Identifier: MIT
#include "pipeline/voxels/visibility.hpp"

namespace clpv {
namespace {

constexpr std::size_t kPoints = 64;  // points per cube between cell centres, one byte each

}  // namespace

VoxelKind visibility_masks(int grid, int cascades) {
  // One cube between centres for each cell except the last ones.
  const VoxelMaskShape shape{grid, grid - 1, kPoints / sizeof(cl_uint),
                             static_cast<std::size_t>(cascades)};
  VoxelKind kind{.what = "cells occluded by triangles",
                 .shape = shape,
                 .max_triangles = 1u << 20,
                 .program = {"voxels/visibility.cl"},
                 .kernel = "occlude_cells",
                 .textured = false};
  kind.program.literals.integer("CLPV_GRID", grid);
  return kind;
}

std::size_t visibility_bytes(int grid) {
  return visibility_masks(grid, 1).shape.bytes();
}

}  // namespace clpv
