// SPDX-License-Identifier: MIT
// What the rasteriser's kernels hand each other: projected vertices, and triangles ready to be drawn.
#ifndef CLPV_SHARED_RASTER_H
#define CLPV_SHARED_RASTER_H

#define CLPV_SUBPIXELS 256  // vertices snap to 1/256 pixel
#define CLPV_TILE 8         // a tile is 8 x 8 pixels; one work-item owns it, a row of it is one float8

// Coordinates in 1/CLPV_SUBPIXELS pixel stay below 2^29, so that products of two differences fit 64 bits:
// what lies farther off than this many pixels is clipped.
#define CLPV_GUARD_PIXELS 1048576.0f

// Where a vertex is relative to the view. A triangle with a bit of the first six in common in all its corners
// is out of sight; one with any of the last three in any corner is clipped.
#define CLPV_LEFT 1
#define CLPV_RIGHT 2
#define CLPV_ABOVE 4
#define CLPV_BELOW 8
#define CLPV_BEYOND 16
#define CLPV_BEHIND 32
#define CLPV_OUT_OF_GUARD 64

#define CLPV_OUT_OF_SIGHT (CLPV_LEFT | CLPV_RIGHT | CLPV_ABOVE | CLPV_BELOW | CLPV_BEYOND | CLPV_BEHIND)
#define CLPV_NEEDS_CLIPPING (CLPV_BEHIND | CLPV_OUT_OF_GUARD)

// Up to this size the edge functions of a triangle fit 32 bits, near it.
#define CLPV_SMALL_PIXELS 64
// And up to this one their 256th part does, within a tile (draw_tiles.cl).
#define CLPV_GIANT_PIXELS 131072

// In `triangle`, beside its index in the scene:
#define CLPV_TRIANGLE_MASKED 0x80000000u  // its material has holes
#define CLPV_TRIANGLE_GIANT 0x40000000u   // a side longer than CLPV_GIANT_PIXELS along x or y
#define CLPV_TRIANGLE_INDEX 0x3fffffffu

typedef struct {
  int x[4], y[4];            // corners [1/CLPV_SUBPIXELS pixel], clockwise on the screen; the fourth is the first
  float key, key_x, key_y;   // at pixel `first`, and its change from pixel to pixel: linear, smaller is nearer;
                             // orthographic: depth, perspective: -1 / depth
  float nearest, farthest;   // least and greatest key of the corners
  unsigned int first, last;  // pixels it may cover: least and greatest x, plus 65536 y
  unsigned int triangle;     // index and flags as above
} ClpvRasterTriangle;

#define CLPV_SIZEOF_RASTER_TRIANGLE 64
#define CLPV_RASTER_WORDS 16

// Counters of a pass: triangles listed, triangles to clip, places for entries, and how often those outgrew 32 bits.
#define CLPV_LISTED 0
#define CLPV_TO_CLIP 1
#define CLPV_ENTERED 2
#define CLPV_ENTERED_TOO_MANY 3
#define CLPV_RASTER_COUNTERS 4

// A tile's triangles are sorted into slices of depth, nearest first: most of what lies behind others is then met when
// they are drawn.
#define CLPV_SLICES 8

// An entry is four words: a tile's slice or CLPV_NO_SLICE, which one of the slice's it is, the triangle's place in the
// list, and its least key. Sorted by slice, the last two are left.
#define CLPV_NO_SLICE 0xffffffffu
#define CLPV_ENTRY_WORDS 4
#define CLPV_ENTRY_GROUP 1024u  // a work-group sorts
#define CLPV_SLICE_CHUNK 256u   // slices that a work-item adds up

#endif
