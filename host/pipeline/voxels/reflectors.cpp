// SPDX-License-Identifier: MIT
#include "pipeline/voxels/reflectors.hpp"

#include "basis/bounce.hpp"
#include "kernels/shared/reflectors.h"

namespace clpv {

static_assert(kCellFaces == CLPV_CELL_FACES);

VoxelKind reflector_masks(const SceneBuffers& scene, int grid, const VolumeFormat& format,
                          bool white) {
  VoxelKind kind{.what = "sides of triangles that reflect",
                 .shape = {grid, grid, CLPV_CELL_FACES * CLPV_FACE_WORDS, 1},
                 .max_triangles = 1u << 18,
                 .program = {"voxels/reflectors.cl"},
                 .kernel = "voxelize_reflectors",
                 .indexed = false,
                 .volume_program = {"voxels/face_albedo.cl"},
                 .volume_kernel = "face_albedo"};
  kind.program.literals.integer("CLPV_GRID", grid)
      .flag("CLPV_MASKED", scene.masked)
      .flag("CLPV_TEXTURED", scene.textured)
      .flag("CLPV_COLOURED", scene.coloured)
      .flag("CLPV_WHITE", white);
  add_volume_literals(kind.volume_program.literals, grid, format);
  add_coefficient_literals(kind.volume_program.literals, kCellFaces);
  return kind;
}

}  // namespace clpv
