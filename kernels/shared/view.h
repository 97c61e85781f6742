// SPDX-License-Identifier: MIT
// View of a camera or of a light, shared by host and kernels.
//
// Screen coordinates of pixel (px, py), row 0 at the top:
//   sx = (2 (px + 1/2) / width - 1) half_width,   sy = (1 - 2 (py + 1/2) / height) half_height.
// Depth is the distance along `forward` [m], 0 for pixels without a surface. The surface at depth d
// is at
//   perspective:   eye + d (forward + sx right + sy up)      half_width, half_height: tangents
//   orthographic:  eye + d forward + sx right + sy up        half_width, half_height: [m]
#pragma once

typedef struct {
  float eye[3];        // [m]
  float orthographic;  // 1: parallel rays; 0: rays through the eye
  float right[3];      // unit, as are up and forward; right x up = -forward
  float half_width;
  float up[3];
  float half_height;
  float forward[3];
  float near_depth;    // [m] perspective: clipping plane; orthographic: smaller depths clamp to it
                       // ("pancaking")
  unsigned int width;  // [pixels]
  unsigned int height;
  float far_depth;     // [m] surfaces beyond are dropped
  float unused;
} ClpvView;

