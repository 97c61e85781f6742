// SPDX-License-Identifier: MIT
#include "pipeline/visibility.hpp"

namespace clpv {
namespace {

constexpr unsigned kMostHiders = 1u << 20;  // a launch
constexpr std::size_t kPoints = 64;         // of a cube between centres, a byte each

ProgramSource program_of(int grid) {
  ProgramSource source{"visibility.cl", {}, {}};
  source.literals.integer("CLPV_GRID", grid);
  return source;
}

/// A cube between centres for each cell but the last ones.
VoxelMaskShape hidden_shape(int grid, int cascades) {
  return {grid, grid - 1, kPoints / sizeof(cl_uint), static_cast<std::size_t>(cascades)};
}

}  // namespace

std::size_t CellVisibility::bytes(int grid) {
  return hidden_shape(grid, 1).bytes();
}

CellVisibility::CellVisibility(Session& session, const SceneBuffers& scene, int grid, int cascades)
    : hidden_(session, scene, hidden_shape(grid, cascades), kMostHiders, "cells hidden by triangles"),
      triangles_(session, program_of(grid), "hide_cells") {}

void CellVisibility::see(std::size_t cascade, const ClpvGrid& grid) {
  hidden_.bring(cascade, grid, triangles_, hidden_.buffer(), hidden_.slot(cascade));
}

}  // namespace clpv
