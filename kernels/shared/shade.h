// SPDX-License-Identifier: MIT
// Quantities that an image can show, and the shadow filter, shared by host and kernels. Images are
// RGBA with alpha 1 on surfaces and all 0 elsewhere; CLPV_SHOW_FULL and CLPV_SHOW_DIRECT show a
// sky, with alpha 1; CLPV_SHOW_FULL also a medium.
#pragma once

enum {
  CLPV_SHOW_FULL,  // radiance [W/m^2/sr]: direct and indirect
  CLPV_SHOW_DIRECT,  // radiance: albedo/pi E of the lights, and emission
  CLPV_SHOW_INDIRECT,  // radiance: albedo/pi E of the volumes
  CLPV_SHOW_IRRADIANCE,  // E of the volumes [W/m^2]
  CLPV_SHOW_ALBEDO,
  CLPV_SHOW_NORMAL,  // world space, components in -1..1
  CLPV_SHOW_DEPTH,  // [m] along the camera's forward axis, three times
};

enum {
  CLPV_SHADOW_TAPS = 4,  // texels along each side of the shadow filter; no map may be smaller
};

// Lift of a receiver along its normal [texels of the shadow map at its depth]: a constant, and a
// part times the sine of the light's angle to the normal. At grazing light it is less: occluders
// that are farther in front of the receiver, along the light, than the filter is wide cast shadows.
#define CLPV_SHADOW_LIFT_FLAT 0.25f
#define CLPV_SHADOW_LIFT_SLOPED 0.5f
#define CLPV_SHADOW_LIFT_DEPTH 3.0f  // [texels]
// Least cosine of the light's angle to the triangle of a curved mesh: below, occluders within the
// filter's width of its plane would let light pass, with the weight of the interpolated normal.
#define CLPV_SHADOW_GRAZING 0.005f

// A receiver below a surface of the map (shadow.h) has no lift, but for rounding: in texels of the
// map, and relative to its depth.
#define CLPV_SHADOW_ROUNDING_TEXELS 0.004f
#define CLPV_SHADOW_ROUNDING_DEPTH 2e-6f
// The same relative to its coordinates, whose roundings grow with the distance from the origin.
#define CLPV_SHADOW_ROUNDING_PLACE 5e-7f
// Share of the filter's weight from which all texels occlude.
#define CLPV_SHADOW_WHOLE 0.999f
