// SPDX-License-Identifier: MIT
// A light, as host and kernels both see it. Photometric quantities are carried 1:1 as radiometric ones.
#ifndef CLPV_SHARED_LIGHT_H
#define CLPV_SHARED_LIGHT_H

#define CLPV_LIGHT_DIRECTIONAL 0
#define CLPV_LIGHT_SPOT 1
#define CLPV_LIGHT_POINT 2

typedef struct {
  float position[3];   // [m]; unused for a directional light
  unsigned int kind;   // CLPV_LIGHT_*
  float direction[3];  // unit, the way its light travels; unused for a point light
  float range;         // [m]; nothing beyond it; 0: unlimited
  float intensity[3];  // directional: irradiance on a plane across it [W/m^2]; else radiant intensity [W/sr]
  float cone_scale;    // spot, glTF: attenuation = clamp(cos(angle) * cone_scale + cone_offset, 0, 1)^2
  float cone_offset;
  float unused[3];
} ClpvLight;

#define CLPV_SIZEOF_LIGHT 64

// [m]; a point nearer to a spot or point light is lit as from here, so that nothing is infinite.
#define CLPV_LIGHT_LEAST_DISTANCE 1e-3f

#endif
