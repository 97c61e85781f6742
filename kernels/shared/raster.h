// SPDX-License-Identifier: MIT
// Data of the rasteriser's kernels: outcodes of vertices, triangles set up for drawing, entries and
// counters; shared by host and kernels.
#pragma once

enum {
  CLPV_SUBPIXELS = 256,  // vertices snap to 1/256 pixel
  CLPV_TILE = 8,  // pixels along each edge of a tile; with eight lanes a work-item draws a tile
                  // (draw_tiles.cl)
};

// Guard band [pixels]: triangles that reach farther are clipped. Coordinates in 1/CLPV_SUBPIXELS
// pixel then stay below 2^29, and products of two differences fit 64 bits.
#define CLPV_GUARD_PIXELS 1048576.0f

// Most corners of a clipped triangle: each of five planes adds one.
enum { CLPV_CLIP_CORNERS = 8 };

// Outcodes of a vertex. A triangle whose corners all share one of the first six bits is invisible.
// A triangle with a corner that has one of the last two bits is clipped.
enum {
  CLPV_LEFT = 1,
  CLPV_RIGHT = 2,
  CLPV_ABOVE = 4,
  CLPV_BELOW = 8,
  CLPV_BEYOND = 16,
  CLPV_BEHIND = 32,
  CLPV_OUT_OF_GUARD = 64,
  CLPV_OUT_OF_SIGHT = CLPV_LEFT | CLPV_RIGHT | CLPV_ABOVE | CLPV_BELOW | CLPV_BEYOND | CLPV_BEHIND,
  CLPV_NEEDS_CLIPPING = CLPV_BEHIND | CLPV_OUT_OF_GUARD,
};

// Up to this size [pixels] the edge functions of a triangle fit 32 bits inside its box.
enum { CLPV_SMALL_PIXELS = 64 };
// Up to this size [pixels] edge functions divided by 256 fit 32 bits within a tile (draw_tiles.cl).
enum { CLPV_GIANT_PIXELS = 131072 };

// Flags in `triangle`, next to its index in the scene:
#define CLPV_TRIANGLE_MASKED 0x80000000u  // its material is masked
#define CLPV_TRIANGLE_GIANT 0x40000000u   // a side is longer than CLPV_GIANT_PIXELS along x or y
#define CLPV_TRIANGLE_INDEX 0x3fffffffu

typedef struct {
  // Corners [1/CLPV_SUBPIXELS pixel], clockwise on the screen; the fourth is the first.
  int x[4], y[4];
  float key, key_x, key_y;  // depth key at pixel `first`, and its change per pixel; linear, smaller
                            // is nearer: depth in orthographic views, -1 / depth in perspective
  float nearest, farthest;   // smallest and largest key of the corners
  unsigned int first, last;  // first and last pixel that it may cover: x + 65536 y
  unsigned int triangle;     // index and flags as above
} ClpvRasterTriangle;

// A triangle cluster in a view. Its triangles lie within tiles `first` to `last`, x + 65536 y, and
// have no key below `nearest`; of parallel views only.
typedef struct {
  unsigned int number;  // CLPV_HIDDEN: nothing of it is visible
  unsigned int view;    // among those that are drawn together
  unsigned int first, last;
  float nearest;
} ClpvViewCluster;
#define CLPV_HIDDEN 0xffffffffu

// A triangle whose entries enter_wide writes.
typedef struct {
  unsigned int index;  // in the list
  unsigned int entry;  // the first
  unsigned int view;
} ClpvWideTriangle;

// Words of a ClpvRasterTriangle.
enum {
  CLPV_NEAREST_WORD = 11,
  CLPV_FIRST_WORD = 13,
  CLPV_LAST_WORD = 14,
  CLPV_TRIANGLE_WORD = 15,
  CLPV_RASTER_WORDS = 16,
};

// Counters of a pass: triangles listed, triangles to clip, wide ones, entries, and overflows of 32
// bits in the number of entries.
enum {
  CLPV_LISTED,
  CLPV_TO_CLIP,
  CLPV_WIDE,
  CLPV_ENTERED,
  CLPV_ENTERED_TOO_MANY,
  CLPV_RASTER_COUNTERS,
};

// With one lane, a triangle whose box overlaps more than CLPV_FEW_TILES tiles is wide: a work-group
// writes its entries. A CPU is faster if one work-item steps through the tiles (a shadow map: 0.7
// ms in place of 5.6).
enum { CLPV_FEW_TILES = 16 };

// Slices of a tile. Its triangles are drawn slice by slice, nearest first, so that most hidden ones
// are skipped. Masked materials are the last slice: each of their pixels needs a texture.
enum { CLPV_DEPTH_SLICES = 8, CLPV_SLICES };

// An entry has four uint32 words: slice of a tile or CLPV_NO_SLICE, number within the slice, index
// of the triangle in the list, and its smallest key. Sorted entries keep the last two.
#define CLPV_NO_SLICE 0xffffffffu
enum {
  CLPV_ENTRY_WORDS = 4,
  CLPV_ENTRY_GROUP = 1024,  // entries that a work-group sorts
};
