// SPDX-License-Identifier: MIT
// Sets the boundary condition of a cascade from the next coarser cascade: light along each
// direction in the cells just outside the grid, interpolated between the coarser cells that these
// cells see.
//
//   D = T from_coarser sum_k w_k s_k D_k / sum_k w_k s_k    (D = L s^2 |w_m|; 0 if none is seen)
//
// over the eight coarser cells k about a finer one: w_k is the trilinear weight, s_k the share of
// the coarser cascade's sample points in the finer cell that see k's centre. T is the share of
// points that no wall hides. from_coarser is in ClpvSweepDirection (docs/method.md, 'The sweep').
#include "shared/sweep.h"
#include "sweep/sweep_border.h"
#include "sweep/sweep_layout.h"

// Along an axis, u is the number of a finer cell from the coarser grid's origin. Its centre is (u -
// 1/2) / 2 coarser cells from the first coarser centre, always 1/4 of a cell off one, so that its
// two neighbours have the weights 3/4 and 1/4.

// Lower one of the two coarser cells about finer cell u, and the weight of the upper one.
static inline int lower_cell(const int u) { return (u - 1) >> 1; }
static inline float upper_weight(const int u) { return u & 1 ? 0.25f : 0.75f; }

// Upstream face of a bin: its axes, and its cell (row, column) by numbers from the coarser grid's
// origin.
typedef struct {
  int axis, row_axis, column_axis;
  int layer, row, column;
} FaceCell;

static inline FaceCell face_cell(__constant const ClpvSweepBin* bin, const int face, const int row,
                                 const int column, const int dx, const int dy, const int dz) {
  FaceCell cell;
  const bool plane_face = face == CLPV_BORDER_PLANE, row_face = face == CLPV_BORDER_ROW;
  const int sign = plane_face ? bin->plane_sign : (row_face ? bin->row_sign : bin->column_sign);
  cell.axis = plane_face ? bin->plane_axis : (row_face ? bin->row_axis : bin->column_axis);
  cell.row_axis = plane_face ? bin->row_axis : bin->plane_axis;
  cell.column_axis = face == CLPV_BORDER_COLUMN ? bin->row_axis : bin->column_axis;
  cell.layer = (sign > 0 ? -1 : CLPV_GRID) + along_axis(cell.axis, dx, dy, dz);
  cell.row = row + along_axis(cell.row_axis, dx, dy, dz);
  cell.column = column + along_axis(cell.column_axis, dx, dy, dz);
  return cell;
}

// Index of a cell of a face of a bin in `hidden`.
static inline int hidden_index(const int face_of_bin, const int row, const int column) {
  return face_of_bin * CLPV_BORDERED_PLANE + (row + 1) * CLPV_SWEEP_PITCH + column + 1;
}

// Bits of the coarser centres about finer cell u that each sample point in it does not see, a byte
// per point; 0 outside the coarser grid.
static inline ulong hidden_centres(__global const ushort* occluded, const uint cascade,
                                   const int3 u) {
  const int3 cube = (u - 1) >> 1, octant = ~u & 1;
  if (any(cube < 0) || any(cube >= CLPV_GRID - 1)) return 0;
  const size_t number =
      ((cascade * (size_t)CLPV_GRID + cube.z) * CLPV_GRID + cube.y) * CLPV_GRID + cube.x;
  // Two points a row, two rows in each of two layers.
  __global const ushort* rows = occluded + 32 * number + 16 * octant.z + 4 * octant.y + octant.x;
  return rows[0] | (ulong)rows[2] << 16 | (ulong)rows[8] << 32 | (ulong)rows[10] << 48;
}

// Bytes of a cell's points this side of its centre. `inwards`: sign of the way inside, 0: none;
// `upper`: bytes of the upper points along its axis.
static inline ulong near_points(const int inwards, const ulong upper) {
  return inwards > 0 ? ~upper : (inwards < 0 ? upper : 0);
}

// Counts what each cell of a border sees, by those of its sample points that see a centre which the
// nearest cell inside the grid sees beyond its own centre, too: others are behind a wall.
//
// In:   occluded  visibility of cell centres (voxels/visibility.cl)
//       cascade   number of the coarser cascade, whose bytes to read
// Out:  hidden    for each face of each bin, a word per cell: 8 less the points that see each of
//                 the eight coarser centres about it, 4 bits each; bit 2 of a centre's number is
//                 upper across the face, bit 1 along columns, bit 0 along rows
//       closed    float per cell: 1 - T
// A work-item counts in a cell.
__kernel void count_hidden_at_border(__constant const ClpvSweepBin* bins, const int dx,
                                     const int dy, const int dz, __global const ushort* occluded,
                                     const uint cascade, __global uint* hidden,
                                     __global float* closed) {
  const int column = (int)get_global_id(0) - 1, row = (int)get_global_id(1) - 1,
            face_of_bin = (int)get_global_id(2);
  if (column > CLPV_GRID) return;
  const FaceCell cell = face_cell(bins + face_of_bin / 3, face_of_bin % 3, row, column, dx, dy, dz);
  const int3 offset = (int3)(dx, dy, dz), axes = (int3)(0, 1, 2),
             u = select(select((int3)(cell.row), (int3)(cell.column), axes == cell.column_axis),
                        (int3)(cell.layer), axes == cell.axis),
             inner = clamp(u - offset, 0, CLPV_GRID - 1) + offset,
             step = ((inner - 1) >> 1) - ((u - 1) >> 1);
  // The inner cell counts by its points beyond its centre: walls may cut it on this side.
  const int3 inwards = inner - u;
  const ulong outside = hidden_centres(occluded, cascade, u),
              inside = hidden_centres(occluded, cascade, inner) |
                       near_points(inwards.x, 0xff00ff00ff00ff00ul) |
                       near_points(inwards.y, 0xffff0000ffff0000ul) |
                       near_points(inwards.z, 0xffffffff00000000ul);
  const ulong halves = inside & inside >> 32, quarters = halves & halves >> 16;
  const uint seen_inside = ~(uint)(quarters & quarters >> 8);
  uint shared = 0;  // centres that the inner cell sees, by their numbers here
  for (int centre = 0; centre < CLPV_CENTRES; ++centre) {
    const int3 there = ((int3)(centre, centre >> 1, centre >> 2) & 1) - step;
    if (all((there & ~1) == 0))
      shared |= (seen_inside >> (there.x | there.y << 1 | there.z << 2) & 1) << centre;
  }
  uint word = 0x88888888u;
  int clear = 0, open = 0;
  for (int point = 0; point < 8; ++point) {
    const uint seen = ~(uint)(outside >> 8 * point) & 255;
    open += seen != 0;
    if ((seen & shared) == 0) continue;
    ++clear;
    for (int centre = 0; centre < CLPV_CENTRES; ++centre) {
      const int k = (centre >> cell.axis & 1) << 2 | (centre >> cell.row_axis & 1) << 1 |
                    (centre >> cell.column_axis & 1);
      word -= (seen >> centre & 1) << 4 * k;
    }
  }
  const int at = hidden_index(face_of_bin, row, column);
  hidden[at] = word;
  closed[at] = 1.0f - (float)clear / (float)max(open, 1);
}

// Light of the lower and upper coarser cells about W finer ones of a row, from number c on. `at`:
// the lower cell about the first.
#if W == 8
CLPV_INLINE void read_neighbours(CLPV_BUFFER_IN from, const int at, const int c, realW* lower,
                                 realW* upper) {
  const float8 v = read_numbers(from, at);
  *lower = c & 1 ? (float8)(v.s0, v.s0, v.s1, v.s1, v.s2, v.s2, v.s3, v.s3)
                 : (float8)(v.s0, v.s1, v.s1, v.s2, v.s2, v.s3, v.s3, v.s4);
  *upper = c & 1 ? (float8)(v.s1, v.s1, v.s2, v.s2, v.s3, v.s3, v.s4, v.s4)
                 : (float8)(v.s1, v.s2, v.s2, v.s3, v.s3, v.s4, v.s4, v.s5);
}
CLPV_INLINE realW upper_weights(const int c) {
  const float t = upper_weight(c), next = 1.0f - t;
  return (float8)(t, next, t, next, t, next, t, next);
}
#else
CLPV_INLINE void read_neighbours(CLPV_BUFFER_IN from, const int at, const int c, realW* lower,
                                 realW* upper) {
  *lower = read_numbers(from, at);
  *upper = read_numbers(from, at + 1);
}
#define upper_weights upper_weight
#endif

// In:   halo_light    D_coarser [W/sr] in the cells of `halo` (sweep_border.h)
//       hidden, closed  of count_hidden_at_border
//       dx, dy, dz    offset of the grid's origin from the coarser one's, in finer cells
//       first_lit     channels below have a dark border
//       face_step     1; 3: only the planes
// Out:  plane_buffer  D [W/sr] in the plane upstream of the grid, from number `upstream` on
//       border        D [W/sr] in the rows and columns upstream of each plane
// A work-item computes W cells of a row of one face, from the cell before the grid on, for all
// ordinates of a bin. From the host: CLPV_COARSER_PARTS, directions of a bin in the coarser
// cascade.
__kernel void sweep_border(__constant const ClpvSweepBin* bins,
                           __constant const ClpvSweepDirection* directions,
                           CLPV_BUFFER_IN halo_light, __global const uint* hidden,
                           __global const float* closed, const ClpvSweepHalo halo, const int dx,
                           const int dy, const int dz, const int first_lit, const int face_step,
                           __global float* plane_buffer, const int upstream,
                           CLPV_BUFFER_OUT border) {
  const int column = W * (int)get_global_id(0) - 1, row = (int)get_global_id(1) - 1,
            face_of_bin = (int)get_global_id(2) * face_step, bin = face_of_bin / 3,
            face = face_of_bin % 3;
  if (column > CLPV_GRID || row > CLPV_GRID) return;
  const FaceCell cell = face_cell(bins + bin, face, row, column, dx, dy, dz);
  const float across = upper_weight(cell.layer), along = upper_weight(cell.row);
  const realW weight = upper_weights(cell.column);
  const int of_cell = hidden_index(face_of_bin, row, column);
  const uintW words = load_lanes(hidden + of_cell);
  realW weights[CLPV_CENTRES], sum = ZERO;
#pragma unroll
  for (int k = 0; k < CLPV_CENTRES; ++k) {
    const realW seen = 8.0f - to_realW(words >> 4 * k & 15u);
    weights[k] = (k >> 2 ? across : 1.0f - across) * (k >> 1 & 1 ? along : 1.0f - along) *
                 (k & 1 ? weight : 1.0f - weight) * seen;
    sum += weights[k];
  }
  // Sums of seen cells are at least 1/64.
  const realW scale = (ONE - load_lanes(closed + of_cell)) / fmax(sum, 1e-3f);
#pragma unroll
  for (int k = 0; k < CLPV_CENTRES; ++k) weights[k] *= scale;
  const int pitch = halo_pitch(halo.side), next = halo.side * pitch;
  const int r = lower_cell(cell.row) - halo_first(halo, cell.row_axis),
            c = lower_cell(cell.column) - halo_first(halo, cell.column_axis);
  for (int channel = 0; channel < 3; ++channel) {
    for (int part = 0; part < CLPV_PARTS; ++part) {
      __constant const ClpvSweepDirection* direction = directions + bin * CLPV_PARTS + part;
      const int coarser = (bin * 3 + channel) * CLPV_COARSER_PARTS + direction->coarser;
      const int first = halo_index(halo, coarser, face, 0, r, c);
      realW in = ZERO;
#pragma unroll
      for (int k = 0; k < CLPV_CENTRES; k += 2) {
        realW lower, upper;
        read_neighbours(halo_light, first + (k >> 2) * next + (k >> 1 & 1) * pitch, cell.column,
                        &lower, &upper);
        in += weights[k] * lower + weights[k + 1] * upper;
      }
      in *= channel < first_lit ? 0.0f : direction->from_coarser;
      const int ordinate = ordinate_of(bin, channel, part);
      if (face == CLPV_BORDER_PLANE) {
        store_lanes(in, plane_buffer + upstream + ordinate * CLPV_BORDERED_PLANE +
                            plane_index(row, column));
      } else {
        write_numbers(border, border_index(ordinate, face, row, column), in);
      }
    }
  }
}
