// SPDX-License-Identifier: MIT
// A light, shared by host and kernels. Photometric quantities count 1:1 as radiometric ones.
#ifndef CLPV_SHARED_LIGHT_H
#define CLPV_SHARED_LIGHT_H

#define CLPV_LIGHT_DIRECTIONAL 0
#define CLPV_LIGHT_SPOT 1
#define CLPV_LIGHT_POINT 2

typedef struct {
  float position[3];   // [m]; unused for a directional light
  unsigned int kind;   // CLPV_LIGHT_*
  float direction[3];  // unit, in which light travels; unused for a point light
  float range;         // [m]; no light beyond it; 0: unlimited
  float intensity[3];  // directional: irradiance across the direction [W/m^2]; others: radiant intensity [W/sr]
  float cone_scale;    // spot, glTF: attenuation = clamp(cos(angle) * cone_scale + cone_offset, 0, 1)^2
  float cone_offset;
  float unused[3];
} ClpvLight;

#define CLPV_SIZEOF_LIGHT 64

// d_min [m]: a smaller distance from a spot or point light counts as this one, so that irradiance stays finite.
#define CLPV_LIGHT_LEAST_DISTANCE 1e-3f

#endif
