// SPDX-License-Identifier: MIT
// Computes the radiance of swept light at points, one direction for each (radiance.h has the
// formula).
//
// In:   view                 only its size: the points fill an image
//       places               positions [m]
//       directions           unit vectors along which light travels
//       CLPV_RADIANCE        grids and packed volumes
// Out:  radiances            L [W/m^2/sr] for each channel, and 0; may be negative
// A work-item processes W points of a row.
#include "gather/radiance.h"
#include "raster/surface_row.h"

__kernel void radiance(const ClpvView view, __global const float4* places,
                       __global const float4* directions, __global float4* radiances,
                       CLPV_RADIANCE) {
  const PixelRow p = find_pixel_row(view);
  if (p.count == 0) return;
  Surfaces s;
  load_points(view, p, places, directions, &s);
  RadianceField field;
  const Vec none = vec(ZERO, ZERO, ZERO);
  sample_radiance(CLPV_PASS_RADIANCE, s.position, ZERO, s.normal, none, none, (intW)(-1), &field);
  const VecLanes w = unpack((intW)(-1), s.normal);
  for (uint i = 0; i < p.count; ++i)
    radiances[s.first + i] = radiance_along(&field.at[i], basis_functions(w.x[i], w.y[i], w.z[i]));
}
