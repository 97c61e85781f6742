// SPDX-License-Identifier: MIT
#include "pipeline/voxels/blockers.hpp"

#include "kernels/shared/blockers.h"

namespace clpv {

VoxelKind blocker_masks(const SceneBuffers& scene, int grid, int cascades,
                        const VolumeFormat& format) {
  VoxelKind kind{
      .what = "masks of triangles that block",
      .shape = {grid + 1, grid + 1, CLPV_BLOCKER_WORDS, static_cast<std::size_t>(cascades)},
      .max_triangles = 1u << 20,
      .program = {"voxels/blockers.cl"},
      .kernel = "voxelize_blockers",
      .volume_program = {"voxels/blocked_areas.cl"},
      .volume_kernel = "blocked_areas"};
  kind.program.literals.integer("CLPV_GRID", grid).flag("CLPV_MASKED", scene.masked);
  add_volume_literals(kind.volume_program.literals, grid, format);
  add_coefficient_literals(kind.volume_program.literals, 3);
  return kind;
}

}  // namespace clpv
