// SPDX-License-Identifier: MIT
// A light and the medium that it passes, shared by host and kernels. Photometric quantities count
// 1:1 as radiometric ones.
#pragma once

enum {
  CLPV_LIGHT_DIRECTIONAL,
  CLPV_LIGHT_SPOT,
  CLPV_LIGHT_POINT,
};

// A homogeneous medium, such as fog or dust, in a box.
//
//   T = exp(-sigma_t l)         transmittance of a path of length l [m] in the box
//   p = (1 - g^2) / (4 pi (1 + g^2 - 2 g w' . w)^(3/2))   [1/sr]   phase function (Henyey and
//                                                                  Greenstein 1941): light travels
//                                                                  along w', then along w
typedef struct {
  float lower[3], upper[3];  // [m] the box
  float scattering[3];       // sigma_s [1/m] of red, green and blue
  float extinction[3];       // sigma_t = sigma_s + sigma_a [1/m]; all 0: no medium
  float anisotropy;          // g in (-1, 1); above 0: forwards
  float unused[3];
} ClpvMedium;

typedef struct {
  float position[3];   // [m]; unused for a directional light
  unsigned int kind;   // CLPV_LIGHT_*
  float direction[3];  // unit, in which light travels; unused for a point light
  float range;         // [m]; no light beyond it; 0: unlimited
  float intensity[3];  // directional: irradiance across the direction [W/m^2]; others: radiant
                       // intensity [W/sr]
  // Spot, glTF: attenuation = clamp(c * cone_scale + cone_offset, 0, 1)^2 with c = cos(angle), or
  // c = cos(angle) - 1 of a cone with a narrow edge: near 1, floats do not resolve cosines.
  float cone_scale;
  float cone_offset;
  unsigned int narrow_cone;  // 0 or 1
  float unused[2];
  ClpvMedium medium;  // attenuates the light
} ClpvLight;

// d_min [m]: a smaller distance from a spot or point light counts as this one, so that irradiance
// stays finite.
#define CLPV_LIGHT_LEAST_DISTANCE 1e-3f
