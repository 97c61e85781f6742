// SPDX-License-Identifier: MIT
// Propagation step with lobes computed at run time, at the cost of the paper's Table 1 (docs/method.md, 'The paper's
// lobes and look-up tables').
//
//   c += sum_f (F_f / pi) A^-1 alpha(n_f),   F_f the flux through face f, n_f its normal
//
// Each face rotates (or projects) a lobe to its normal. With CLPV_EVALUATE_AT_RUN_TIME the flux, too, uses basis
// functions evaluated along the link. Normals and links are read from memory, so that compilers cannot fold them;
// look-up tables are arguments. From the host: CLPV_FACES, CLPV_UNIT_FLUX, CLPV_EVALUATE_AT_RUN_TIME,
// functions_of_link(link), and the text of host/codegen/inject_source.hpp.
#ifndef CLPV_RUN_TIME_LOBES_H
#define CLPV_RUN_TIME_LOBES_H

// Coefficients of a lobe of 1 W about a normal.
CLPV_INLINE Coefficients run_time_lobe(const float4 normal CLPV_AND_TABLE) {
  const Coefficients alpha = lobe_integrals(normal.x, normal.y, normal.z CLPV_PASS_TABLE);
#if CLPV_UNIT_FLUX
  const float scale = 1.0f / lobe_flux(alpha);
#else
  const float scale = M_1_PI_F;
#endif
  Coefficients scaled;
#define CLPV_DO(i) scaled.c##i = scale * alpha.c##i;
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return project_sum(scaled);
}

CLPV_INLINE Target add_lobe(Target gained, const float flux, const Coefficients lobe) {
#define CLPV_DO(i) gained.c##i = fma(flux, lobe.c##i, gained.c##i);
  CLPV_EACH_TARGET(CLPV_DO)
#undef CLPV_DO
  return gained;
}

CLPV_INLINE Target no_gain(void) {
  Target gained;
#define CLPV_DO(i) gained.c##i = 0.0f;
  CLPV_EACH_TARGET(CLPV_DO)
#undef CLPV_DO
  return gained;
}

#if CLPV_EVALUATE_AT_RUN_TIME
// Flux [W] of a cell's light through a face. `at`: basis functions along the face's link, times its solid angle.
CLPV_INLINE float flux_through(const Source from, const Coefficients at) {
  float flux = 0.0f;
#define CLPV_DO(i) flux = fma(at.c##i, from.c##i, flux);
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return fmax(flux, 0.0f);
}

// Evaluates the functions of all faces, once for all channels.
#define CLPV_EVALUATE_FUNCTIONS                     \
  Coefficients at[CLPV_FACES];                      \
  for (int face = 0; face < CLPV_FACES; ++face) {   \
    at[face] = functions_of_link(links[face] CLPV_PASS_FUNCTIONS); \
  }
#else
#define CLPV_EVALUATE_FUNCTIONS
#endif

// Fluxes through the faces of cell (x, y, z) in a channel.
#define CLPV_CHANNEL_FLUXES(CHANNEL)                  \
  {                                                   \
    const int channel = CHANNEL;                      \
    float* through = fluxes + CHANNEL * CLPV_FACES;   \
    CLPV_EACH_NEIGHBOUR(CLPV_LOAD_NEIGHBOUR)          \
    CLPV_ARRIVE                                       \
  }

#define CLPV_STORE_CHANNEL(CHANNEL, gained)         \
  target_store(target, CHANNEL, x, y, z, gained); \
  target_store(sum, CHANNEL, x, y, z, target_sum(target_load(sum_so_far, CHANNEL, x, y, z), gained));

// A step of all three channels, which share each lobe.
#define CLPV_STEP_WITH_LOBES                                                        \
  float fluxes[3 * CLPV_FACES];                                                     \
  CLPV_EVALUATE_FUNCTIONS                                                           \
  CLPV_CHANNEL_FLUXES(0)                                                            \
  CLPV_CHANNEL_FLUXES(1)                                                            \
  CLPV_CHANNEL_FLUXES(2)                                                            \
  Target red = no_gain(), green = red, blue = red;                             \
  for (int face = 0; face < CLPV_FACES; ++face) {                                   \
    const Coefficients lobe = run_time_lobe(normals[face] CLPV_PASS_TABLE);             \
    red = add_lobe(red, fluxes[face], lobe);                                   \
    green = add_lobe(green, fluxes[CLPV_FACES + face], lobe);                  \
    blue = add_lobe(blue, fluxes[2 * CLPV_FACES + face], lobe);                \
  }                                                                                 \
  CLPV_STORE_CHANNEL(0, red)                                                        \
  CLPV_STORE_CHANNEL(1, green)                                                      \
  CLPV_STORE_CHANNEL(2, blue)

#endif
