// SPDX-License-Identifier: MIT
// Light at one point, for kernels of programs that use the library: Renderer::lookup_source() is
// this file with all that it includes, for the renderer's options. A kernel that looks up light has
// the parameters CLPV_RADIANCE; opencl::Volumes holds their arguments:
//
//   __kernel void mine(__global float4* out, CLPV_RADIANCE) {
//     out[0] = clpv_irradiance(CLPV_PASS_RADIANCE, (float3)(0, 1, 0), (float3)(0, 0, 1));
//   }
#pragma once

#include "gather/radiance.h"

CLPV_INLINE Vec vec_at(const float3 v) {
  return vec((realW)(v.x), (realW)(v.y), (realW)(v.z));
}

// E [W/m^2] of red, green and blue, and 0, on a surface at `position` [m] with the unit normal
// `normal`.
CLPV_INLINE float4 clpv_irradiance(CLPV_RADIANCE, const float3 position, const float3 normal) {
  const Vec none = vec(ZERO, ZERO, ZERO);
  RadianceField field;
  sample_radiance(CLPV_PASS_RADIANCE, vec_at(position), (realW)(CLPV_GATHER_OFFSET), vec_at(normal),
                  none, none, lane_numbers() == 0, &field);
  return field_irradiance(&field.at[0], normal.x, normal.y, normal.z);
}

// L [W/m^2/sr] of red, green and blue, and 0, at `position` [m], of light that travels along the
// unit vector `direction`; may be negative.
CLPV_INLINE float4 clpv_radiance(CLPV_RADIANCE, const float3 position, const float3 direction) {
  const Vec none = vec(ZERO, ZERO, ZERO);
  RadianceField field;
  sample_radiance(CLPV_PASS_RADIANCE, vec_at(position), ZERO, vec_at(direction), none, none,
                  lane_numbers() == 0, &field);
  return radiance_along(&field.at[0], basis_functions(direction.x, direction.y, direction.z));
}
