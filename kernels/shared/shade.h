// SPDX-License-Identifier: MIT
// Quantities that an image can show, and the shadow filter, shared by host and kernels. Images are RGBA with alpha 1 on
// surfaces and all 0 elsewhere; the first two show a sky, with alpha 1, and the first a medium.
#ifndef CLPV_SHARED_SHADE_H
#define CLPV_SHARED_SHADE_H

#define CLPV_SHOW_FULL 0        // radiance [W/m^2/sr]: direct and indirect
#define CLPV_SHOW_DIRECT 1      // radiance: albedo/pi E of the lights, and emission
#define CLPV_SHOW_INDIRECT 2    // radiance: albedo/pi E of the volumes
#define CLPV_SHOW_IRRADIANCE 3  // E of the volumes [W/m^2]
#define CLPV_SHOW_ALBEDO 4
#define CLPV_SHOW_NORMAL 5  // world space, components in -1..1
#define CLPV_SHOW_DEPTH 6   // [m] along the camera's forward axis, three times

#define CLPV_SHADOW_TAPS 4  // texels along each side of the shadow filter; no map may be smaller

// Lift of a receiver along its normal [texels of the shadow map at its depth]: a constant, and a part times the sine of
// the light's angle to the normal.
#define CLPV_SHADOW_LIFT_FLAT 0.25f
#define CLPV_SHADOW_LIFT_SLOPED 0.5f

#endif
