// SPDX-License-Identifier: MIT
// What an image can show of a frame, as host and kernels both name it; every one is RGBA, alpha 1 where a surface is
// and all 0 elsewhere; of the first two, a sky is what is seen there, with alpha 1.
#ifndef CLPV_SHARED_SHADE_H
#define CLPV_SHARED_SHADE_H

#define CLPV_SHOW_FULL 0        // radiance [W/m^2/sr]: direct and indirect
#define CLPV_SHOW_DIRECT 1      // radiance that no other surface passed on: albedo/pi E of the lights, and emission
#define CLPV_SHOW_INDIRECT 2    // radiance: albedo/pi E of the volumes
#define CLPV_SHOW_IRRADIANCE 3  // E of the volumes [W/m^2]
#define CLPV_SHOW_ALBEDO 4
#define CLPV_SHOW_NORMAL 5  // world space, components in -1..1
#define CLPV_SHOW_DEPTH 6   // [m] along the camera's forward axis, three times

#define CLPV_SHADOW_TAPS 4  // texels along each side of the shadow filter; no map may be smaller

// How far a receiver is lifted off itself along its normal [texels of the shadow map where it lies]: always, and times
// the sine of the light's angle to the normal. Against ray-cast shadows in Sponza at 1024^2 texels, twice as much
// doubles the light that leaks under ledges (1 to 2 % of the dark pixels) and saves .1 % of the lit ones from their own
// shadow.
#define CLPV_SHADOW_LIFT_FLAT 0.25f
#define CLPV_SHADOW_LIFT_SLOPED 0.5f

#endif
