// SPDX-License-Identifier: MIT
// W triangles on the screen: which pixels' centres they may cover, and their place in the list of
// those to draw.
#pragma once

#include "raster/tile_entries.h"
#include "raster/project.h"

// W triangles of the scene, projected to the screen.
typedef struct {
  ScreenCorner a, b, c;
  Face face;
  uintW triangle;  // index in the scene
  uintW flags;     // flags of the material
} ScreenTriangles;

// Box of pixels whose centres lie between the corners of a triangle.
typedef struct {
  intW left, right, top, bottom;
  intW small, giant;  // masks: no side above CLPV_SMALL_PIXELS; a side above CLPV_GIANT_PIXELS
} Box;

static inline intW smallest(const intW a, const intW b, const intW c) { return min(a, min(b, c)); }
static inline intW largest(const intW a, const intW b, const intW c) { return max(a, max(b, c)); }

// First pixel whose centre is at or after a sub-pixel coordinate, and last pixel whose centre is at
// or before it.
static inline intW first_centre(const intW at) { return (at + CLPV_SUBPIXELS / 2 - 1) >> 8; }
static inline intW last_centre(const intW at) { return (at - CLPV_SUBPIXELS / 2) >> 8; }

static inline Box box_of(const ClpvView view, const ScreenTriangles t) {
  const intW min_x = smallest(t.a.x, t.b.x, t.c.x), min_y = smallest(t.a.y, t.b.y, t.c.y);
  const intW max_x = largest(t.a.x, t.b.x, t.c.x), max_y = largest(t.a.y, t.b.y, t.c.y);
  Box box;
  box.left = max(first_centre(min_x), (intW)(0));
  box.right = min(last_centre(max_x), (intW)((int)view.width - 1));
  box.top = max(first_centre(min_y), (intW)(0));
  box.bottom = min(last_centre(max_y), (intW)((int)view.height - 1));
  const intW longest = max(max_x - min_x, max_y - min_y);
  box.small = longest <= CLPV_SMALL_PIXELS * CLPV_SUBPIXELS;
  box.giant = longest > CLPV_GIANT_PIXELS * CLPV_SUBPIXELS;
  return box;
}

// Sign of the area on the screen; positive is clockwise, with y downwards.
static inline intW winding(const ScreenTriangles t) {
  const longW area = to_longW(t.b.x - t.a.x) * to_longW(t.c.y - t.a.y) -
                     to_longW(t.c.x - t.a.x) * to_longW(t.b.y - t.a.y);
  const intW clockwise = to_intW(area > 0L), other = to_intW(area < 0L);
  return clockwise ? (intW)(1) : (other ? (intW)(-1) : (intW)(0));
}

// Edge function at the upper left pixel of a box of at most 2 x 2 pixels, and its change across the
// box. 0 in lanes outside `tiny`, whose coordinates may not fit 32 bits.
typedef struct {
  intW value, step_x, step_y;
} TinyEdge;

static inline TinyEdge tiny_edge(const ScreenCorner p, const ScreenCorner q, const Box box,
                                 const intW tiny) {
  const intW dx = (q.x - p.x) & tiny, dy = (q.y - p.y) & tiny;
  const intW to_x = (box.left * CLPV_SUBPIXELS + CLPV_SUBPIXELS / 2 - p.x) & tiny;
  const intW to_y = (box.top * CLPV_SUBPIXELS + CLPV_SUBPIXELS / 2 - p.y) & tiny;
  const intW top_left = all_bits((dy < 0) | ((dy == 0) & (dx > 0)));
  TinyEdge edge;
  edge.value = dx * to_y - dy * to_x - 1 - top_left;
  edge.step_x = -dy * ((box.right - box.left) * CLPV_SUBPIXELS & tiny);
  edge.step_y = dx * ((box.bottom - box.top) * CLPV_SUBPIXELS & tiny);
  return edge;
}

// Mask of the triangles with a box of at most 2 x 2 pixels that cover no pixel centre. Exact; about
// a third of such triangles are dropped.
static inline intW covers_no_centre(const ScreenTriangles t, const Box box) {
  const intW tiny = all_bits(box.small & (box.right - box.left <= 1) & (box.bottom - box.top <= 1));
  const TinyEdge e0 = tiny_edge(t.a, t.b, box, tiny), e1 = tiny_edge(t.b, t.c, box, tiny),
                 e2 = tiny_edge(t.c, t.a, box, tiny);
  const intW right0 = e0.value + e0.step_x, right1 = e1.value + e1.step_x,
             right2 = e2.value + e2.step_x;
  const intW out = (e0.value | e1.value | e2.value) & (right0 | right1 | right2) &
                   (e0.value + e0.step_y | e1.value + e1.step_y | e2.value + e2.step_y) &
                   (right0 + e0.step_y | right1 + e1.step_y | right2 + e2.step_y);
  return tiny & (out < 0);
}

// Converts to the words of ClpvRasterTriangle.
CLPV_INLINE void write_words(const ClpvView view, const ScreenTriangles t, const Box box,
                             RasterWords* words) {
  const realW nearest = fmin(t.a.key, fmin(t.b.key, t.c.key)),
              farthest = fmax(t.a.key, fmax(t.b.key, t.c.key));
  const Vec plane = find_key_plane(view, t.face, to_realW(box.left), to_realW(box.top));
  const intW edge_on = (isfinite(plane.x) & isfinite(plane.y) & isfinite(plane.z)) == 0;
  const uintW kinds =
      (box.giant ? (uintW)(CLPV_TRIANGLE_GIANT) : (uintW)(0u)) |
      ((t.flags & CLPV_MATERIAL_MASKED) != 0u ? (uintW)(CLPV_TRIANGLE_MASKED) : (uintW)(0u));
  store_lanes(t.a.x, words->word[0]);
  store_lanes(t.b.x, words->word[1]);
  store_lanes(t.c.x, words->word[2]);
  store_lanes(t.a.x, words->word[3]);
  store_lanes(t.a.y, words->word[4]);
  store_lanes(t.b.y, words->word[5]);
  store_lanes(t.c.y, words->word[6]);
  store_lanes(t.a.y, words->word[7]);
  store_lanes(as_intW(edge_on ? nearest : plane.x), words->word[8]);
  store_lanes(as_intW(edge_on ? ZERO : plane.y), words->word[9]);
  store_lanes(as_intW(edge_on ? ZERO : plane.z), words->word[10]);
  store_lanes(as_intW(nearest), words->word[CLPV_NEAREST_WORD]);
  store_lanes(as_intW(farthest), words->word[12]);
  store_lanes(box.left + (box.top << 16), words->word[CLPV_FIRST_WORD]);
  store_lanes(box.right + (box.bottom << 16), words->word[CLPV_LAST_WORD]);
  store_lanes(as_intW(t.triangle | kinds), words->word[CLPV_TRIANGLE_WORD]);
}

// Returns the lanes of `mask` but for triangles that cover no pixel's centre and culled back faces,
// and converts those that remain.
CLPV_INLINE intW find_words(const ClpvView view, ScreenTriangles t, intW mask, const uint cull,
                            RasterWords* words) {
  const intW wound = winding(t);
  const intW one_sided = (t.flags & CLPV_MATERIAL_DOUBLE_SIDED) == 0u;
  mask &= (wound < 0) | ((wound > 0) & ((cull ? 0 : -1) | (one_sided == 0)));
  const Box box = box_of(view, t);
  mask &= (box.left <= box.right) & (box.top <= box.bottom);
  if (no_lane(mask)) return mask;
  const ScreenCorner b = t.b, c = t.c;
  t.b.x = wound < 0 ? c.x : b.x, t.b.y = wound < 0 ? c.y : b.y;
  t.c.x = wound < 0 ? b.x : c.x, t.c.y = wound < 0 ? b.y : c.y;
  mask &= covers_no_centre(t, box) == 0;
  if (!no_lane(mask)) write_words(view, t, box, words);
  return mask;
}

// Appends the triangles of find_words().
CLPV_INLINE void append(const ClpvView view, const ScreenTriangles t, intW mask, const uint cull,
                        volatile __global uint* counts, const Capacity capacity,
                        __global ClpvRasterTriangle* list, const Entries entries) {
  RasterWords words;
  mask = find_words(view, t, mask, cull, &words);
  if (no_lane(mask)) return;
  const Places room = needed(&words, mask);
  list_lanes(view, &words, mask, room, reserve(counts, room), counts, capacity, list, entries);
}
