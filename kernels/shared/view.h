// SPDX-License-Identifier: MIT
// A viewpoint, as host and kernels both see it: a camera, or a light that looks at what it lights.
//
// A pixel (px, py), its row 0 at the top, looks through
//   sx = (2 (px + 1/2) / width - 1) half_width,   sy = (1 - 2 (py + 1/2) / height) half_height.
// Depth is the distance along `forward` [m], 0 where there is no surface. A surface at depth d is at
//   perspective:   eye + d (forward + sx right + sy up)      half_width, half_height: tangents
//   orthographic:  eye + d forward + sx right + sy up        half_width, half_height: [m]
#ifndef CLPV_SHARED_VIEW_H
#define CLPV_SHARED_VIEW_H

typedef struct {
  float eye[3];        // [m]
  float orthographic;  // 1: parallel rays; 0: rays through the eye
  float right[3];      // unit, as are up and forward; right x up = -forward
  float half_width;
  float up[3];
  float half_height;
  float forward[3];
  float near_depth;    // [m]; perspective: clipped here. Orthographic: depths before it clamp to it ("pancaking")
  unsigned int width;  // [pixels]
  unsigned int height;
  float far_depth;     // [m]; surfaces beyond are dropped
  float unused;
} ClpvView;

#define CLPV_SIZEOF_VIEW 80

#endif
