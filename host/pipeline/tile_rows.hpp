// SPDX-License-Identifier: MIT
// Launches over what a view sees: a work-item is eight pixels of a row, a row of a tile (kernels/tile_row.h).
#pragma once

#include <CL/opencl.hpp>

#include "kernels/shared/raster.h"
#include "kernels/shared/view.h"

namespace clpv {

inline unsigned tiles_along(unsigned pixels) {
  return (pixels + CLPV_TILE - 1) / CLPV_TILE;
}
inline cl::NDRange rows_of_tiles(const ClpvView& view) {
  return {tiles_along(view.width), view.height};
}
/// Rows differ in work: small groups even it out between cores.
inline const cl::NDRange kTileRow(8, 1);

}  // namespace clpv
