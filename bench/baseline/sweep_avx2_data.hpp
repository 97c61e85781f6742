// SPDX-License-Identifier: MIT
// What the sweep by hand works on: shapes of volumes and planes, its directions, and all its memory (sweep_avx2.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "basis/sweep.hpp"
#include "basis/transport.hpp"
#include "bench/baseline/avx2.hpp"
#include "support/error.hpp"

#ifdef _OPENMP
#include <omp.h>
#endif

#if CLPV_HAS_AVX2
namespace clpv::bench::sweep_by_hand {

inline constexpr int kChannels = 3, kTaps = 4, kKept = 9, kAreas = 3;
inline constexpr int kWays =
    9;  // from the plane before: from a lower, the same, an upper row, and such columns
inline constexpr int kAlike = 4;    // bins across an axis of one sign along it
inline constexpr int kOctants = 8;  // bins across an axis: one for each sign along x, y, z
inline constexpr double kSame = 1e-9;

inline void require(bool fits) {
  if (!fits)
    throw Error(ExitCode::run_time,
                "baseline: made for a sweep of bins24 blocked by areas, whose constants these are not");
}

inline bool same(double a, double b) {
  return std::abs(a - b) < kSame;
}

/// A volume of n^3 numbers, slice by slice across z. A cache line more a slice and a volume: else rows of a plane across y, and
/// volumes, would share the few places of a cache that powers of two have.
struct Shape {
  int n;
  std::ptrdiff_t row() const { return n; }
  std::ptrdiff_t slice() const { return std::ptrdiff_t{n} * n + 16; }
  std::ptrdiff_t volume() const { return n * slice() + 16; }
};

/// A plane of light on its way: rows between zeros, eight before each, which stand after the one before as well.
struct LiveShape {
  int n;
  std::ptrdiff_t row() const { return n + kLane; }
  std::ptrdiff_t plane() const { return (n + 2) * row() + 2 * kLane; }
  std::ptrdiff_t at(int r, int c) const { return (r + 1) * row() + kLane + c; }
};

/// A direction's t_k and share; and t_1 / t_0 and t_2 / t_0, of the one cell aside, which with t_0 make all four. Each eight times.
struct alignas(32) Direction {
  float taps[kTaps][kLane], aside[kLane], above[kLane], share[kLane];
};

struct Bin {
  int axis, row_axis, column_axis;
  int plane_sign, row_sign, column_sign;
  int octant;      // of signs: bit i set where light goes downwards along axis i
  int way[kTaps];  // of the nine
  std::vector<Direction> directions;
};

inline int octant(const glm::ivec3& sign) {
  return (sign.x < 0 ? 1 : 0) + (sign.y < 0 ? 2 : 0) + (sign.z < 0 ? 4 : 0);
}

inline std::vector<Bin> bins_of(int parts) {
  std::vector<Bin> bins;
  for (const SweepBin& from : sweep_bins(parts)) {
    Bin bin{from.axis,         from.v, from.u, from.sign[from.axis], from.sign[from.v], from.sign[from.u],
            octant(from.sign), {},     {}};
    for (std::size_t k = 0; k < kTaps; ++k)
      bin.way[k] = 3 * (from.offset[k][from.v] + 1) + from.offset[k][from.u] + 1;
    for (const SweepDirection& d : from.directions) {
      Direction to{};
      const auto set = [](float(&lanes)[kLane], double value) {
        std::fill_n(lanes, kLane, static_cast<float>(value));
      };
      for (std::size_t k = 0; k < kTaps; ++k) set(to.taps[k], d.taps[k]);
      set(to.aside, d.taps[1] / d.taps[0]);
      set(to.above, d.taps[2] / d.taps[0]);
      require(same(d.taps[0] * d.taps[3], d.taps[1] * d.taps[2]));
      set(to.share, d.solid_angle / (d.flux * from.solid_angle));
      bin.directions.push_back(to);
    }
    bins.push_back(bin);
  }
  return bins;
}

/// The nine harmonics of 24 bins. Over the eight bins across an axis each is plus or minus one number, by the signs of x, y and z:
/// bit i of `pattern` tells whether the sign along axis i counts.
struct Projection {
  int bin[3][kOctants];
  int pattern[kKept];
  float weight[3][kKept];
};

inline Projection projection_of() {
  Projection p{};
  const std::vector<SweepBin> bins = sweep_bins(1);
  for (int b = 0; b < kSweepBins; ++b) {
    const SweepBin& bin = bins[static_cast<std::size_t>(b)];
    p.bin[bin.axis][octant(bin.sign)] = b;
  }
  const Matrix matrix = swept_projection();
  require(matrix.rows() == kKept);
  for (int j = 0; j < kKept; ++j) {
    for (int axis = 0; axis < 3; ++axis) {
      const double weight = matrix(j, p.bin[axis][0]);
      if (std::abs(weight) < kSame) continue;
      p.weight[axis][j] = static_cast<float>(weight);
      p.pattern[j] = 0;
      for (int i = 0; i < 3; ++i) {
        if (matrix(j, p.bin[axis][1 << i]) * weight < 0) p.pattern[j] |= 1 << i;
      }
      for (unsigned s = 0; s < kOctants; ++s) {
        const bool minus = __builtin_popcount(s & static_cast<unsigned>(p.pattern[j])) % 2 == 1;
        require(same(matrix(j, p.bin[axis][s]), minus ? -weight : weight));
      }
    }
  }
  return p;
}

/// What the nine ways across an axis, one way along it, weigh the areas across its planes, rows and columns by, each over the
/// number of corners that they are the mean of.
struct Ways {
  float planes[kWays], rows[kWays], columns[kWays];
};

inline Ways ways_across(const OperatorTransport& transport, const Bin& bin) {
  Ways ways{};
  for (const auto& way : transport.neighbours) {
    if (way.offset[bin.axis] != bin.plane_sign) continue;
    require(way.blocked_by.size() == kAreas);
    const int row = way.offset[bin.row_axis], column = way.offset[bin.column_axis];
    const int corners = (row == 0 ? 2 : 1) * (column == 0 ? 2 : 1), at = 3 * (row + 1) + column + 1;
    const auto weight = [&](int axis) {
      return static_cast<float>(way.blocked_by[static_cast<std::size_t>(axis)] / corners);
    };
    ways.planes[at] = weight(bin.axis), ways.rows[at] = weight(bin.row_axis);
    ways.columns[at] = weight(bin.column_axis);
    require((row != 0 || ways.rows[at] == 0) && (column != 0 || ways.columns[at] == 0));
  }
  return ways;
}

/// Areas at the cells' corners: rows of n + 1, and room for whole tiles.
struct CornerShape {
  int n;
  std::ptrdiff_t row() const { return n + kLane; }
  std::ptrdiff_t slice() const { return row() * row() + 16; }
  std::ptrdiff_t volume() const { return (n + 1) * slice() + 16; }
};

/// Of a thread.
struct Scratch {
  Plane live, sources, sums, open;  // sources, sums: eight planes across x; open: a plane of each way
};

/// What a baseline sweeps: its volumes, directions and room.
struct Swept {
  Shape shape;
  LiveShape live;
  CornerShape corner;
  std::vector<Bin> bins;
  int alike[6][kAlike] = {};  // bins across x upwards, x downwards, y ...
  Ways ways[6] = {};          // of these
  Projection projection;
  bool blocks = false;
  Plane injected;                 // 3 x 24 volumes
  Plane sums;                     // at most as many: of the channels and axes that are swept at once
  Plane kept;                     // 3 x 9
  Plane corners, turned_corners;  // 3 volumes; turned: rows along y, above each other along x
  std::vector<Scratch> scratch;

  Swept(const Transport& transport, int grid, int parts)
      : shape{grid},
        live{grid},
        corner{grid},
        bins(bins_of(parts)),
        projection(projection_of()),
        injected(volumes(kChannels * kSweepBins)),
        sums(volumes(kChannels * kSweepBins)),
        kept(volumes(kChannels * kKept)),
        corners(static_cast<std::size_t>(kAreas * corner.volume())),
        turned_corners(static_cast<std::size_t>(kAreas * corner.volume())) {
    const auto* scheme = std::get_if<OperatorTransport>(&transport.scheme);
    require(scheme != nullptr && transport.kind == TransportKind::sweep);
    int found[6] = {};
    for (int b = 0; b < kSweepBins; ++b) {
      const int group = group_of(bin(b));
      alike[group][found[group]++] = b;
      ways[group] = ways_across(*scheme, bin(b));
    }
    const std::size_t directions = bins.front().directions.size();
    const auto slice = static_cast<std::size_t>(shape.slice());
    for (int i = 0; i < threads(); ++i) {
      scratch.push_back({Plane(kAlike * kChannels * directions * static_cast<std::size_t>(live.plane())),
                         Plane(kAlike * kChannels * kLane * slice), Plane(kLane * slice),
                         Plane(kWays * slice)});
    }
  }
  static int group_of(const Bin& bin) { return 2 * bin.axis + (bin.plane_sign > 0 ? 0 : 1); }
  static int threads() {
#ifdef _OPENMP
    return omp_get_max_threads();
#else
    return 1;
#endif
  }
  static int thread() {
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
  }
  const Bin& bin(int b) const {
    return bins[static_cast<std::size_t>(b)];
  }
  std::size_t volumes(int count) const {
    return static_cast<std::size_t>(count) * static_cast<std::size_t>(shape.volume());
  }
  /// Few threads sweep and collect one axis after the other, whose sums stay in cache, and four bins together, which find out
  /// together what the ways let through; more need more tasks.
  int axes_at_once() const {
    return threads() <= 2 ? 1 : 3;
  }
  int alike_at_once() const {
    return blocks && threads() <= kSweepBins / kAlike ? kAlike : 1;
  }
  /// Where a bin's sums are, of the first channel at once, and how far the next channel's are.
  int sum_of(const Bin& bin) const {
    return (bin.axis % axes_at_once()) * kOctants + bin.octant;
  }
  std::ptrdiff_t sum_channel() const {
    return axes_at_once() * kOctants * shape.volume();
  }
  double cells() const {
    return std::pow(shape.n, 3);
  }
  double directions() const {
    return static_cast<double>(bins.front().directions.size()) * kSweepBins;
  }
};

/// The areas at a slice of corners, turned for planes across x.
void turn_corners(const Swept& p, int z);

/// `count` bins alike in axis and sign along it, together plane by plane: of `channel`, or where something blocks of all channels,
/// past what ways let through, which is found on the way.
void sweep_alike(const Swept& p, const int* numbers, int count, int channel, Scratch& scratch);

/// Nine harmonics of the cells of a slice: what the bins across an axis add. `sums`: of these, in the order of octants.
void collect(const Swept& p, int axis, const float* sums, int channel, int z);

}  // namespace clpv::bench::sweep_by_hand
#endif
