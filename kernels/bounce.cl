// SPDX-License-Identifier: MIT
// What a sweep leaves falls on the surfaces of its cells, and they send it back (docs/method.md, 'More bounces').
//
//   bounce         light to sweep += what is sent back of what was swept
//   bounce_send    light to sweep += what is sent back of 1 W on each face
//   bounce_meet    from that, swept: what surfaces send back, and all that is sent back of it further on
//   bounce_on      light to sweep += what is sent back of what was swept first, and in all bounces of what was swept second
//   bounce_finer   light to sweep += what a cascade sends back of `arriving`, what falls on faces in the next coarser one
//
// In: `swept` (sweep.cl), as radiance times s^2; `reflectors`, six numbers a cell and channel (reflectors.cl), or those that
// bounce_meet makes of them; `arriving` (sweep_collect.cl). In and out: `light`, a volume for each channel and bin (sweep.h).
//
// Of 1 W that leaves a side, others send back E, what falls on that side where each of them sends back what it does of 1 W on its
// face: light goes both ways alike. Where they send back what they do in all their bounces, so is E.
//
// The host writes (host/codegen/sweep_source.cpp) Coefficients, of six sides; Swept, of 24 bins; CLPV_EACH_X_BIN and the
// like (sweep_source.cl); and
//   Coefficients clpv_arriving(Swept)    flux on each whole face [W]
//   Swept clpv_leaving(Coefficients)     light of flux that leaves each side [W/sr]
// A work-item is a tile of CLPV_LANES x CLPV_LANES cells of a slice of one channel. Tiles without a surface are left alone.
#include "coefficients.h"
#include "coarse_to_fine.h"
#include "shared/sweep.h"
#include "sweep.h"
#include "volume/light.h"

CLPV_INLINE Swept clpv_none(void) {
  Swept s;
#define CLPV_DO(b) s.c##b = 0.0f;
  CLPV_EACH_SWEPT(CLPV_DO)
#undef CLPV_DO
  return s;
}

// Flux that leaves each side of a cell: what arrives times what it reflects.
CLPV_INLINE Coefficients clpv_sent_back(const Coefficients arriving, const Coefficients reflector) {
  Coefficients sent;
#define CLPV_DO(i) sent.c##i = arriving.c##i * reflector.c##i;
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return sent;
}

// What a side reflects, times 1 + what is sent back to it.
CLPV_INLINE Coefficients clpv_in_all(const Coefficients arriving, const Coefficients reflector) {
  Coefficients sent;
#define CLPV_DO(i) sent.c##i = reflector.c##i * (1.0f + arriving.c##i);
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return sent;
}

// Whether any side of a tile's cells reflects.
CLPV_INLINE int clpv_tile_reflects(CLPV_VOLUME_IN reflectors, const int channel, const int x, const int y, const int z) {
  CLPV_REAL all = 0.0f;
  for (int r = 0; r < CLPV_LANES; ++r) {
    if (y + r >= CLPV_GRID) break;
    const Coefficients reflector = light_load(reflectors, channel, x, y + r, z);
#define CLPV_DO(i) all += reflector.c##i;
    CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  }
#if CLPV_LANES == 8
  const float4 four = all.lo + all.hi;
  return four.x + four.y + four.z + four.w != 0.0f;
#else
  return all != 0.0f;
#endif
}

// Adds what cells send back: row by row, and to turned rows when all of a tile is known.
CLPV_INLINE void clpv_add_row(const Swept s, CLPV_BUFFER_OUT light, const int x, const int y, const int z) {
#define CLPV_ADD(b, at)                               \
  CLPV_SWEEP_STORE(light + b * CLPV_SWEEP_VOLUME, at, \
                   CLPV_WITHIN(x, CLPV_SWEEP_LOAD(light + b * CLPV_SWEEP_VOLUME, at) + s.c##b));
#define CLPV_DO(b) CLPV_ADD(b, clpv_sweep_at(z, y, x))
  CLPV_EACH_Z_BIN(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(b) CLPV_ADD(b, clpv_sweep_at(y, z, x))
  CLPV_EACH_Y_BIN(CLPV_DO)
#undef CLPV_DO
}

CLPV_INLINE void clpv_add_turned(const Tile* tile, CLPV_BUFFER_OUT light, const int x, const int y, const int z) {
  for (int b = 0; b < CLPV_X_BINS; ++b) {
    const Tile turned = clpv_turn(tile[b]);
    for (int r = 0; r < CLPV_LANES; ++r) {
      if (x + r >= CLPV_GRID) break;
      const int at = b * CLPV_SWEEP_VOLUME + clpv_sweep_at(x + r, z, y);
      CLPV_SWEEP_STORE(light, at, CLPV_SWEEP_LOAD(light, at) + turned.row[r]);
    }
  }
}

// What arrives at row r of a tile, y along the grid.
CLPV_INLINE Coefficients clpv_arriving_at(const Tile* tile, const int r, CLPV_BUFFER_IN swept, const int x, const int y,
                                          const int z) {
  const int across_z = clpv_sweep_at(z, y, x), across_y = clpv_sweep_at(y, z, x);
  Swept m;
#define CLPV_DO(b) m.c##b = tile[b].row[r];
  CLPV_EACH_X_BIN(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(b) m.c##b = CLPV_SWEEP_LOAD(swept + b * CLPV_SWEEP_VOLUME, across_y);
  CLPV_EACH_Y_BIN(CLPV_DO)
#undef CLPV_DO
#define CLPV_DO(b) m.c##b = CLPV_SWEEP_LOAD(swept + b * CLPV_SWEEP_VOLUME, across_z);
  CLPV_EACH_Z_BIN(CLPV_DO)
#undef CLPV_DO
  return clpv_arriving(m);
}

// A tile's least cell, and where its channel's volumes begin.
#define CLPV_TILE                                                                               \
  const int x = CLPV_LANES * (int)get_global_id(0), y = CLPV_LANES * (int)get_global_id(1);     \
  const int z = (int)get_global_id(2) % CLPV_GRID, channel = (int)get_global_id(2) / CLPV_GRID; \
  if (x >= CLPV_GRID || y >= CLPV_GRID) return;                                                 \
  const int first = channel * CLPV_SWEEP_BINS * CLPV_SWEEP_VOLUME;

// Adds what a tile's cells send back: flux `sent` in row r.
CLPV_INLINE void clpv_put_row(const Swept s, const int r, Tile* tile) {
#define CLPV_DO(b) tile[b].row[r] = s.c##b;
  CLPV_EACH_X_BIN(CLPV_DO)
#undef CLPV_DO
}
#define CLPV_SEND_BACK(sent)                       \
  for (int r = 0; r < CLPV_LANES; ++r) {           \
    Swept s = clpv_none();                         \
    if (y + r < CLPV_GRID) {                       \
      s = clpv_leaving(sent);                      \
      clpv_add_row(s, light + first, x, y + r, z); \
    }                                              \
    clpv_put_row(s, r, tile);                      \
  }                                                \
  clpv_add_turned(tile, light + first, x, y, z);

__kernel void bounce(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors, CLPV_BUFFER_OUT light) {
  CLPV_TILE
  if (!clpv_tile_reflects(reflectors, channel, x, y, z)) return;
  Tile tile[CLPV_X_BINS];
  clpv_load_tiles(swept + first, CLPV_X_BINS, x, y, z, tile);
  CLPV_SEND_BACK(clpv_sent_back(clpv_arriving_at(tile, r, swept + first, x, y + r, z),
                                light_load(reflectors, channel, x, y + r, z)))
}

__kernel void bounce_on(CLPV_BUFFER_IN first_swept, CLPV_BUFFER_IN second_swept, CLPV_VOLUME_IN reflectors,
                        CLPV_VOLUME_IN in_all, CLPV_BUFFER_OUT light) {
  CLPV_TILE
  if (!clpv_tile_reflects(reflectors, channel, x, y, z)) return;
  Tile tile[CLPV_X_BINS], second[CLPV_X_BINS];
  clpv_load_tiles(first_swept + first, CLPV_X_BINS, x, y, z, tile);
  clpv_load_tiles(second_swept + first, CLPV_X_BINS, x, y, z, second);
  CLPV_SEND_BACK(clpv_add(clpv_sent_back(clpv_arriving_at(tile, r, first_swept + first, x, y + r, z),
                                         light_load(reflectors, channel, x, y + r, z)),
                          clpv_sent_back(clpv_arriving_at(second, r, second_swept + first, x, y + r, z),
                                         light_load(in_all, channel, x, y + r, z))))
}

__kernel void bounce_send(CLPV_VOLUME_IN reflectors, CLPV_BUFFER_OUT light) {
  CLPV_TILE
  if (!clpv_tile_reflects(reflectors, channel, x, y, z)) return;
  Tile tile[CLPV_X_BINS];
  CLPV_SEND_BACK(light_load(reflectors, channel, x, y + r, z))
}

__kernel void bounce_meet(CLPV_BUFFER_IN swept, CLPV_VOLUME_IN reflectors, CLPV_VOLUME_OUT in_all) {
  CLPV_TILE
  Tile tile[CLPV_X_BINS];
  clpv_load_tiles(swept + first, CLPV_X_BINS, x, y, z, tile);
  for (int r = 0; r < CLPV_LANES; ++r) {
    if (y + r >= CLPV_GRID) break;
    const Coefficients arriving = clpv_arriving_at(tile, r, swept + first, x, y + r, z);
    light_store(in_all, channel, x, y + r, z, clpv_in_all(arriving, light_load(reflectors, channel, x, y + r, z)));
  }
}

// What falls on a side of finer cells, a row of them from (x, y, z) on: of a coarser face, they have a quarter of the area.
CLPV_INLINE CLPV_REAL clpv_from_coarser(CLPV_BUFFER_IN arriving, const int x, const int y, const int z) {
  CLPV_BUFFER_IN from = arriving + clpv_bordered_at(CLPV_LOWER(z), CLPV_LOWER(y), CLPV_LOWER(x));
  const float tz = CLPV_UPPER_WEIGHT(z), ty = CLPV_UPPER_WEIGHT(y);
#define CLPV_ACROSS(at)                                                                              \
  ((1.0f - tz) * ((1.0f - ty) * CLPV_SWEEP_LOAD(from, at) + ty * CLPV_SWEEP_LOAD(from, (at) + CLPV_SWEEP_PITCH)) + \
   tz * ((1.0f - ty) * CLPV_SWEEP_LOAD(from, (at) + CLPV_SWEEP_LIVE) +                               \
         ty * CLPV_SWEEP_LOAD(from, (at) + CLPV_SWEEP_LIVE + CLPV_SWEEP_PITCH)))
  const CLPV_REAL v = CLPV_ACROSS(0);
#if CLPV_LANES == 8
  return 0.25f * (x & 1 ? CLPV_ODD(v) : CLPV_EVEN(v));
#else
  const float tx = CLPV_UPPER_WEIGHT(x);
  return 0.25f * ((1.0f - tx) * v + tx * CLPV_ACROSS(1));
#endif
}

CLPV_INLINE Coefficients clpv_all_from_coarser(CLPV_BUFFER_IN arriving, const int x, const int y, const int z) {
  Coefficients all;
#define CLPV_DO(i) all.c##i = clpv_from_coarser(arriving + i * CLPV_BORDERED_VOLUME, x, y, z);
  CLPV_EACH_COEFFICIENT(CLPV_DO)
#undef CLPV_DO
  return all;
}

// dx, dy, dz: from the coarser grid's least corner to the finer one's, in finer cells (coarse_to_fine.h).
__kernel void bounce_finer(CLPV_BUFFER_IN arriving, const int dx, const int dy, const int dz, CLPV_VOLUME_IN reflectors,
                           CLPV_BUFFER_OUT light) {
  CLPV_TILE
  if (!clpv_tile_reflects(reflectors, channel, x, y, z)) return;
  CLPV_BUFFER_IN in = arriving + channel * CLPV_N * CLPV_BORDERED_VOLUME;
  Tile tile[CLPV_X_BINS];
  CLPV_SEND_BACK(clpv_sent_back(clpv_all_from_coarser(in, x + dx, y + r + dy, z + dz),
                                light_load(reflectors, channel, x, y + r, z)))
}
