// SPDX-License-Identifier: MIT
#include "bench/baseline/sweep_avx2.hpp"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <utility>

#include "basis/sweep.hpp"
#include "support/error.hpp"

#ifdef _OPENMP
#include <omp.h>
#endif

namespace clpv::bench {

#if CLPV_HAS_AVX2

namespace {

constexpr int kChannels = 3, kTaps = 4, kKept = 9, kAreas = 3;
constexpr int kWays = 9;     // from the plane before: from a lower, the same, an upper row, and such columns
constexpr int kAlike = 4;    // bins across an axis of one sign along it
constexpr int kOctants = 8;  // bins across an axis: one for each sign along x, y, z
constexpr double kSame = 1e-9;

void require(bool fits) {
  if (!fits)
    throw Error(ExitCode::run_time,
                "baseline: made for a sweep of bins24 blocked by areas, whose constants these are not");
}

bool same(double a, double b) {
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

int octant(const glm::ivec3& sign) {
  return (sign.x < 0 ? 1 : 0) + (sign.y < 0 ? 2 : 0) + (sign.z < 0 ? 4 : 0);
}

std::vector<Bin> bins_of(int parts) {
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

Projection projection_of() {
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

Ways ways_across(const OperatorTransport& transport, const Bin& bin) {
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

}  // namespace

struct SweepBaseline::Impl {
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

  Impl(const Transport& transport, int grid, int parts)
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

namespace {

using Impl = SweepBaseline::Impl;

struct Tile {
  __m256 row[kLane];
};

/// Its rows turned into columns.
CLPV_AVX2 inline Tile turn(const Tile& a) {
  __m256 pairs[8], fours[8];
  for (int i = 0; i < 4; ++i) {
    pairs[2 * i] = _mm256_unpacklo_ps(a.row[2 * i], a.row[2 * i + 1]);
    pairs[2 * i + 1] = _mm256_unpackhi_ps(a.row[2 * i], a.row[2 * i + 1]);
  }
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      fours[4 * i + 2 * j] = _mm256_shuffle_ps(pairs[4 * i + j], pairs[4 * i + 2 + j], 0x44);
      fours[4 * i + 2 * j + 1] = _mm256_shuffle_ps(pairs[4 * i + j], pairs[4 * i + 2 + j], 0xee);
    }
  }
  Tile t;
  for (int i = 0; i < 4; ++i) {
    t.row[i] = _mm256_permute2f128_ps(fours[i], fours[4 + i], 0x20);
    t.row[4 + i] = _mm256_permute2f128_ps(fours[i], fours[4 + i], 0x31);
  }
  return t;
}

/// A plane to sweep. `row` and `next`: to the next row and plane of sources and sums, planes in the order they are swept in.
struct View {
  const float* sources;
  float* sums;  // may be the same, where something blocks
  std::ptrdiff_t row, next, channel, sum_channel;
  const float* ways[kTaps];
  std::ptrdiff_t ways_row;
};

/// A plane of light on its way. Rows and columns downstream are swept first, so that each plane replaces the one before.
struct Live {
  float* values;
  LiveShape shape;
  std::ptrdiff_t row, aside, part;  // to the row and the column upstream, and to the next part or channel
};

/// Eight columns of kCount directions of one channel, where nothing blocks: all four taps from two cells aside in each of two
/// rows. The upper row's pair is the next lower one's.
template <int kCount, bool kFirst>
CLPV_AVX2 inline void sweep_free(const Direction* d, const Live& of, const View& view, int row, int column) {
  const std::ptrdiff_t row_up = of.row, column_up = of.aside, part = of.part;  // which no store can change
  const std::ptrdiff_t up = of.row > 0 ? view.row : -view.row, next = view.next;
  const int n = of.shape.n;
  float* live = of.values + of.shape.at(row, column);
  const float* source = view.sources + row * view.row + column;
  float* sum = view.sums + row * view.row + column;
  __m256 aside[kCount], above[kCount], tap[kCount], share[kCount], here[kCount];
  const auto pair = [&](const float* at, int i) CLPV_AVX2 {
    return _mm256_fmadd_ps(aside[i], _mm256_loadu_ps(at + i * part + column_up),
                           _mm256_load_ps(at + i * part));
  };
  for (int i = 0; i < kCount; ++i) {
    aside[i] = _mm256_load_ps(d[i].aside), above[i] = _mm256_load_ps(d[i].above);
    tap[i] = _mm256_load_ps(d[i].taps[0]), share[i] = _mm256_load_ps(d[i].share);
    here[i] = pair(live, i);
  }
  for (int r = 0; r < n; ++r, live += row_up, source += up, sum += up) {
    if (kFirst) {
      _mm_prefetch(source + next, _MM_HINT_T0);
      __builtin_prefetch(sum + next, 1);
    }
    const __m256 injected = _mm256_load_ps(source);
    __m256 all = kFirst ? _mm256_setzero_ps() : _mm256_load_ps(sum);
    for (int i = 0; i < kCount; ++i) {
      const __m256 upper = pair(live + row_up, i);
      const __m256 light = _mm256_fmadd_ps(tap[i], _mm256_fmadd_ps(above[i], upper, here[i]), injected);
      _mm256_store_ps(live + i * part, light);
      all = kFirst && i == 0 ? _mm256_mul_ps(share[i], light) : _mm256_fmadd_ps(share[i], light, all);
      here[i] = upper;
    }
    _mm256_store_ps(sum, all);
  }
}

/// Eight cells, all channels of all directions, which share what the ways let through. kCount: of directions; 0: `count`.
template <int kCount>
CLPV_AVX2 inline void sweep_blocked(const Direction* d, int count, const Live& of, const View& view, int row,
                                    int column) {
  const std::ptrdiff_t row_up = of.row, column_up = of.aside, part = of.part;  // which no store can change
  const std::ptrdiff_t channel = view.channel, sum_channel = view.sum_channel;
  const std::ptrdiff_t at = row * view.ways_row + column;
  const float* source = view.sources + row * view.row + column;
  float* sums = view.sums + row * view.row + column;
  float* live = of.values + of.shape.at(row, column);
  const __m256 open0 = _mm256_load_ps(view.ways[0] + at), open1 = _mm256_load_ps(view.ways[1] + at);
  const __m256 open2 = _mm256_load_ps(view.ways[2] + at), open3 = _mm256_load_ps(view.ways[3] + at);
  __m256 injected[kChannels], sum[kChannels];
  for (int c = 0; c < kChannels; ++c) {
    _mm_prefetch(source + c * channel + view.next, _MM_HINT_T0);
    __builtin_prefetch(sums + c * sum_channel + view.next, 1);
    injected[c] = _mm256_load_ps(source + c * channel);
    sum[c] = _mm256_setzero_ps();
  }
  for (int i = 0; i < (kCount > 0 ? kCount : count); ++i, ++d) {
    const __m256 w0 = _mm256_mul_ps(open0, _mm256_load_ps(d->taps[0]));
    const __m256 w1 = _mm256_mul_ps(open1, _mm256_load_ps(d->taps[1]));
    const __m256 w2 = _mm256_mul_ps(open2, _mm256_load_ps(d->taps[2]));
    const __m256 w3 = _mm256_mul_ps(open3, _mm256_load_ps(d->taps[3]));
    for (int c = 0; c < kChannels; ++c, live += part) {
      __m256 light = _mm256_fmadd_ps(w0, _mm256_load_ps(live), injected[c]);
      light = _mm256_fmadd_ps(w1, _mm256_loadu_ps(live + column_up), light);
      light = _mm256_fmadd_ps(w2, _mm256_load_ps(live + row_up), light);
      light = _mm256_fmadd_ps(w3, _mm256_loadu_ps(live + row_up + column_up), light);
      _mm256_store_ps(live, light);
      sum[c] = _mm256_fmadd_ps(_mm256_load_ps(d->share), light, sum[c]);
    }
  }
  for (int c = 0; c < kChannels; ++c) _mm256_store_ps(sums + c * sum_channel, sum[c]);
}

/// One channel of a plane, whose directions' planes stay in the first-level cache: by eight columns.
CLPV_AVX2 void sweep_free_plane(const Bin& bin, const Live& live, const View& view) {
  const int n = live.shape.n, count = static_cast<int>(bin.directions.size());
  const int row = bin.row_sign > 0 ? n - 1 : 0;
  const Direction* d = bin.directions.data();
  for (int i = 0; i < n; i += kLane) {
    const int column = bin.column_sign > 0 ? n - kLane - i : i;
    if (count == 1) {
      sweep_free<1, true>(d, live, view, row, column);
      continue;
    }
    sweep_free<2, true>(d, live, view, row, column);
    Live next = live;
    for (int at = 2; at < count; at += 2) {
      next.values = live.values + at * live.part;
      if (at + 1 < count) {
        sweep_free<2, false>(d + at, next, view, row, column);
      } else {
        sweep_free<1, false>(d + at, next, view, row, column);
      }
    }
  }
}

/// A plane of all channels, a row after the other.
CLPV_AVX2 void sweep_blocked_plane(const Bin& bin, const Live& live, const View& view) {
  const int n = live.shape.n, count = static_cast<int>(bin.directions.size());
  for (int i = 0; i < n; ++i) {
    const int row = bin.row_sign > 0 ? n - 1 - i : i;
    for (int j = 0; j < n; j += kLane) {
      const int column = bin.column_sign > 0 ? n - kLane - j : j;
      if (count == 4) {
        sweep_blocked<4>(bin.directions.data(), count, live, view, row, column);
      } else {
        sweep_blocked<0>(bin.directions.data(), count, live, view, row, column);
      }
    }
  }
}

/// Eight planes across x, from x on: out of a volume, and into it.
constexpr int kAhead = 2;  // slices that are asked for before their turn
CLPV_AVX2 void turn_planes(const Shape& s, const float* volume, int x, float* planes) {
  for (int z = 0; z < s.n; ++z) {
    for (int y = 0; y < s.n; y += kLane) {
      Tile tile;
      for (int i = 0; i < kLane; ++i) {
        const float* row = volume + z * s.slice() + (y + i) * s.row() + x;
        _mm_prefetch(row + kAhead * s.slice(), _MM_HINT_T0);
        tile.row[i] = _mm256_load_ps(row);
      }
      tile = turn(tile);
      for (int i = 0; i < kLane; ++i) _mm256_store_ps(planes + i * s.slice() + z * s.row() + y, tile.row[i]);
    }
  }
}
CLPV_AVX2 void turn_back(const Shape& s, const float* planes, int x, float* volume) {
  for (int z = 0; z < s.n; ++z) {
    for (int y = 0; y < s.n; y += kLane) {
      Tile tile;
      for (int i = 0; i < kLane; ++i) tile.row[i] = _mm256_load_ps(planes + i * s.slice() + z * s.row() + y);
      tile = turn(tile);
      for (int i = 0; i < kLane; ++i) {
        float* row = volume + z * s.slice() + (y + i) * s.row() + x;
        __builtin_prefetch(row + kAhead * s.slice(), 1);
        _mm256_store_ps(row, tile.row[i]);
      }
    }
  }
}

/// What ways let through into the cells of a plane: 1 - B, B the mean over the corners that they pass.
CLPV_AVX2 void open_plane(const Impl& p, const Bin& bin, int plane, float* open) {
  const Ways& ways = p.ways[Impl::group_of(bin)];
  const CornerShape& s = p.corner;
  const std::ptrdiff_t next_plane = bin.axis == 2 ? s.slice() : s.row();
  const std::ptrdiff_t row = bin.axis == 2 ? s.row() : s.slice(), next = p.shape.slice();
  const float* corners = (bin.axis == 0 ? p.turned_corners : p.corners).data() +
                         (plane + (bin.plane_sign > 0 ? 0 : 1)) * next_plane;
  const float* areas[kAreas] = {corners + bin.axis * s.volume(), corners + bin.row_axis * s.volume(),
                                corners + bin.column_axis * s.volume()};
  const __m256 zero = _mm256_setzero_ps(), one = _mm256_set1_ps(1.0f);
  for (int r = 0; r < s.n; ++r, open += p.shape.row()) {
    for (int c = 0; c < s.n; c += kLane) {
      // Sums over corners of both sides (0), the lower one (1), the upper one (2), of rows and of columns.
      __m256 sums[kAreas][3][3];
      for (int area = 0; area < kAreas; ++area) {
        auto& of = sums[area];
        for (int i = 0; i < 2; ++i) {
          for (int j = 0; j < 2; ++j) of[1 + i][1 + j] = _mm256_loadu_ps(areas[area] + (r + i) * row + c + j);
          of[1 + i][0] = _mm256_add_ps(of[1 + i][1], of[1 + i][2]);
        }
        for (int j = 0; j < 3; ++j) of[0][j] = _mm256_add_ps(of[1][j], of[2][j]);
      }
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          constexpr int kFrom[3] = {1, 2,
                                    0};  // light on its way up comes from below, and passes the lower corners
          const int w = 3 * kFrom[i] + kFrom[j];
          __m256 through = _mm256_fnmadd_ps(_mm256_set1_ps(ways.planes[w]), sums[0][i][j], one);
          if (i != 0) through = _mm256_fnmadd_ps(_mm256_set1_ps(ways.rows[w]), sums[1][i][j], through);
          if (j != 0) through = _mm256_fnmadd_ps(_mm256_set1_ps(ways.columns[w]), sums[2][i][j], through);
          _mm256_store_ps(open + w * next + c, _mm256_min_ps(one, _mm256_max_ps(zero, through)));
        }
      }
    }
  }
}

CLPV_AVX2 void turn_corners(const Impl& p, int z) {
  const CornerShape& s = p.corner;
  for (int area = 0; area < kAreas; ++area) {
    const std::ptrdiff_t slice = area * s.volume() + z * s.slice();
    for (int y = 0; y <= s.n; y += kLane) {
      for (int x = 0; x <= s.n; x += kLane) {
        Tile tile;
        for (int i = 0; i < kLane; ++i)
          tile.row[i] = _mm256_load_ps(p.corners.data() + slice + (y + i) * s.row() + x);
        tile = turn(tile);
        for (int i = 0; i < kLane; ++i)
          _mm256_store_ps(p.turned_corners.data() + slice + (x + i) * s.row() + y, tile.row[i]);
      }
    }
  }
}

/// A plane across y or z of the volumes from those on.
View view_of(const Impl& p, const Bin& bin, const float* injected, float* sums, int plane) {
  const Shape& s = p.shape;
  const std::ptrdiff_t step = bin.axis == 1 ? s.row() : s.slice(), row = bin.axis == 1 ? s.slice() : s.row();
  return {injected + plane * step, sums + plane * step, row, bin.plane_sign * step,
          kSweepBins * s.volume(), p.sum_channel(),     {},  s.row()};
}

/// The same across x: out of eight planes that have been turned.
View turned_view(const Impl& p, const Scratch& scratch, int number, int plane) {
  const Shape& s = p.shape;
  const std::ptrdiff_t eight = kLane * s.slice(), from = plane % kLane * s.slice();
  float* sources = scratch.sources.data() + number * kChannels * eight + from;
  return {sources, p.blocks ? sources : scratch.sums.data() + from, s.row(), 0, eight, eight, {}, s.row()};
}

/// `count` bins alike in axis and sign along it, together plane by plane: of `channel`, or where something blocks of all channels,
/// past what ways let through, which is found on the way.
CLPV_AVX2 void sweep_alike(const Impl& p, const int* numbers, int count, int channel, Scratch& scratch) {
  const Bin& first = p.bin(numbers[0]);
  const Shape& s = p.shape;
  const int channels = p.blocks ? kChannels : 1, n = s.n;
  const std::ptrdiff_t a_bin =
      kChannels * static_cast<std::ptrdiff_t>(first.directions.size()) * p.live.plane();
  const std::ptrdiff_t eight = kLane * s.slice();
  scratch.live.clear();
  for (int i = 0; i < n; ++i) {
    const int plane = first.plane_sign > 0 ? i : n - 1 - i, x = plane / kLane * kLane;
    if (p.blocks) open_plane(p, first, plane, scratch.open.data());
    for (int k = 0; k < count; ++k) {
      const Bin& bin = p.bin(numbers[k]);
      const float* injected = p.injected.data() + (channel * kSweepBins + numbers[k]) * s.volume();
      float* sums = p.sums.data() + p.sum_of(bin) * s.volume();
      for (int c = 0; c < channels && bin.axis == 0 && i % kLane == 0; ++c)
        turn_planes(s, injected + c * kSweepBins * s.volume(), x,
                    scratch.sources.data() + (k * kChannels + c) * eight);
      View view = bin.axis == 0 ? turned_view(p, scratch, k, plane) : view_of(p, bin, injected, sums, plane);
      for (int t = 0; t < kTaps; ++t) view.ways[t] = scratch.open.data() + bin.way[t] * s.slice();
      const Live live{scratch.live.data() + k * a_bin, p.live, -bin.row_sign * p.live.row(), -bin.column_sign,
                      p.live.plane()};
      if (p.blocks) {
        sweep_blocked_plane(bin, live, view);
      } else {
        sweep_free_plane(bin, live, view);
      }
      for (int c = 0; c < channels && bin.axis == 0 && i % kLane == kLane - 1; ++c)
        turn_back(s, view.sums - plane % kLane * s.slice() + c * eight, x, sums + c * p.sum_channel());
    }
  }
}

/// Sums over eight numbers with all patterns of signs: to[pattern] (Walsh and Hadamard).
CLPV_AVX2 inline void transform(__m256 (&v)[kOctants]) {
  for (int bit = 1; bit < kOctants; bit *= 2) {
    for (int i = 0; i < kOctants; ++i) {
      if ((i & bit) != 0) continue;
      const __m256 a = v[i], b = v[i + bit];
      v[i] = _mm256_add_ps(a, b), v[i + bit] = _mm256_sub_ps(a, b);
    }
  }
}

/// Nine harmonics of the cells of a slice: what the bins across an axis add. `sums`: of these, in the order of octants.
CLPV_AVX2 void collect(const Impl& p, int axis, const float* sums, int channel, int z) {
  const Shape& s = p.shape;
  const Projection& projection = p.projection;
  float* kept = p.kept.data() + channel * kKept * s.volume() + z * s.slice();
  constexpr int kSoon = 8 * 16;  // cells
  for (int at = 0; at < s.n * s.n; at += kLane) {
    __m256 v[kOctants];
    for (int i = 0; i < kOctants; ++i) {
      const float* sum = sums + i * s.volume() + z * s.slice() + at;
      if (at % 16 == 0) _mm_prefetch(sum + kSoon, _MM_HINT_T0);
      v[i] = _mm256_load_ps(sum);
    }
    transform(v);
    for (int j = 0; j < kKept; ++j) {
      float* to = kept + j * s.volume() + at;
      if (at % 16 == 0) __builtin_prefetch(to + kSoon, 1);
      const __m256 weight = _mm256_set1_ps(projection.weight[axis][j]), value = v[projection.pattern[j]];
      _mm256_store_ps(
          to, axis == 0 ? _mm256_mul_ps(weight, value) : _mm256_fmadd_ps(weight, value, _mm256_load_ps(to)));
    }
  }
}

// Operations by hand, as written above, a cell.
constexpr double kOpenFlops = 6 * (5 + 2 + 2 + 2 * (1 + 2 * 2 + 2 * 2 + 4 * 3) + kWays * 2);
constexpr double kCollectFlops = kChannels * (3 * (3 * kOctants + 2 * kKept) - kKept);

}  // namespace

SweepBaseline::SweepBaseline(const Basis& basis, const Transport& transport, int grid, int parts) {
  if (grid % kLane != 0)
    throw Error(ExitCode::run_time, "baseline: grid {}; allowed: multiples of {}", grid, kLane);
  const Matrix means = bin_means(basis);
  require(basis.size() == kSweepBins);
  for (int b = 0; b < kSweepBins; ++b) {
    for (int i = 0; i < kSweepBins; ++i) require(same(means(b, i), b == i ? 1 : 0));
  }
  impl_ = std::make_unique<Impl>(transport, grid, parts);
}

void SweepBaseline::set(const std::vector<float>& injected, const std::vector<float>* geometry) {
  Impl& p = *impl_;
  const auto n = static_cast<std::size_t>(p.shape.n), slice = n * n;
  for (std::size_t i = 0; i < kChannels * kSweepBins * n; ++i) {
    std::copy_n(injected.data() + i * slice, slice,
                p.injected.data() + p.volumes(static_cast<int>(i / n)) +
                    (i % n) * static_cast<std::size_t>(p.shape.slice()));
  }
  p.blocks = geometry != nullptr;
  const std::size_t side = n + 1;
  for (std::size_t i = 0; i < kAreas * side * side && p.blocks; ++i) {
    const auto area = static_cast<std::ptrdiff_t>(i / side / side);
    const auto z = static_cast<std::ptrdiff_t>(i / side % side), y = static_cast<std::ptrdiff_t>(i % side);
    std::copy_n(geometry->data() + i * side, side,
                p.corners.data() + area * p.corner.volume() + z * p.corner.slice() + y * p.corner.row());
  }
}

void SweepBaseline::sweep() {
  Impl& p = *impl_;
  const int n = p.shape.n;
  const int channels = p.blocks ? kChannels : 1;  // at once: they share what ways let through
  const int alike = p.alike_at_once(), axes = p.axes_at_once();
#pragma omp parallel
  {
    if (p.blocks) {
#pragma omp for schedule(static)
      for (int z = 0; z <= n; ++z) turn_corners(p, z);
    }
    for (int channel = 0; channel < kChannels; channel += channels) {
      for (int axis = 0; axis < 3; axis += axes) {
#pragma omp for schedule(dynamic)
        for (int b = axis * kOctants; b < (axis + axes) * kOctants; b += alike) {
          sweep_alike(p, &p.alike[b / kAlike][b % kAlike], alike, channel,
                      p.scratch[static_cast<std::size_t>(Impl::thread())]);
        }
#pragma omp for schedule(static) collapse(2)
        for (int c = 0; c < channels; ++c) {
          for (int z = 0; z < n; ++z) {
            for (int i = 0; i < axes; ++i)
              collect(p, axis + i, p.sums.data() + c * p.sum_channel() + i * kOctants * p.shape.volume(),
                      channel + c, z);
          }
        }
      }
    }
  }
}

std::vector<float> SweepBaseline::accumulated() const {
  const Impl& p = *impl_;
  const std::ptrdiff_t slice = std::ptrdiff_t{p.shape.n} * p.shape.n;
  std::vector<float> values;
  for (int volume = 0; volume < kChannels * kKept; ++volume) {
    for (int z = 0; z < p.shape.n; ++z) {
      const float* from = p.kept.data() + volume * p.shape.volume() + z * p.shape.slice();
      values.insert(values.end(), from, from + slice);
    }
  }
  return values;
}

double SweepBaseline::flops() const {
  const Impl& p = *impl_;
  if (!p.blocks)  // of each bin the first share is no addition
    return p.cells() * (kChannels * (p.directions() * (3 + 1) * 2 - kSweepBins) + kCollectFlops);
  return p.cells() * (p.directions() * (kTaps + kChannels * (kTaps + 1) * 2) + kCollectFlops +
                      kOpenFlops * kAlike / p.alike_at_once());
}

double SweepBaseline::bytes() const {
  const Impl& p = *impl_;
  const double light = kChannels * (3 * kSweepBins + kKept);  // injected, sums written and read, kept
  return sizeof(float) * p.cells() * (light + (p.blocks ? kAreas : 0));
}

double SweepBaseline::working_set() const {
  const Impl& p = *impl_;
  const double sums = (p.blocks ? kChannels : 1) * p.axes_at_once() * kOctants;
  return sizeof(float) * p.cells() * (kChannels * (kSweepBins + kKept) + sums + (p.blocks ? kAreas : 0));
}

#else  // no AVX2 on this architecture

struct SweepBaseline::Impl {};
SweepBaseline::SweepBaseline(const Basis&, const Transport&, int, int) {
  throw Error(ExitCode::run_time, "baseline: needs a processor with AVX2");
}
void SweepBaseline::set(const std::vector<float>&, const std::vector<float>*) {}
void SweepBaseline::sweep() {}
std::vector<float> SweepBaseline::accumulated() const {
  return {};
}
double SweepBaseline::flops() const {
  return 0;
}
double SweepBaseline::bytes() const {
  return 0;
}
double SweepBaseline::working_set() const {
  return 0;
}

#endif

SweepBaseline::~SweepBaseline() = default;

}  // namespace clpv::bench
