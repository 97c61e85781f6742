// SPDX-License-Identifier: MIT
// Sets the boundary condition of the coarsest cascade from a sky: the same light along a direction
// in every cell just outside the grid.
//
//   D = L s^2 |w_m|      (docs/method.md, 'The sweep')
//
// In:   sky           L |w_m| [W/m^2/sr] for each ordinate, L the mean radiance of the sky over the
//                     direction's part
//       scale         s^2 [m^2] times the number that volumes store for 1 W/sr
// Out:  plane_buffer  D in the plane upstream of the grid, from number `upstream` on
//       border        D in the rows and columns upstream of each plane
// A work-item computes W cells of a row of one face, from the cell before the grid on.
#include "shared/sweep.h"
#include "sweep/sweep_layout.h"
#include "sweep/sweep_border.h"

__kernel void sweep_sky(__global const float* sky, const float scale, __global float* plane_buffer,
                        const int upstream, CLPV_BUFFER_OUT border) {
  const int column = W * (int)get_global_id(0) - 1, row = (int)get_global_id(1) - 1,
            face = (int)get_global_id(2) % 3;
  const int ordinate = (int)get_global_id(2) / 3;
  if (column > CLPV_GRID || row > CLPV_GRID) return;
  const realW in = scale * sky[ordinate];
  if (face == CLPV_BORDER_PLANE) {
    store_lanes(
        in, plane_buffer + upstream + ordinate * CLPV_BORDERED_PLANE + plane_index(row, column));
  } else {
    write_numbers(border, border_index(ordinate, face, row, column), in);
  }
}
