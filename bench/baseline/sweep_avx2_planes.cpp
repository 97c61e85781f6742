// SPDX-License-Identifier: MIT
// The sweep by hand, plane by plane.
#include "bench/baseline/sweep_avx2_data.hpp"

#if CLPV_HAS_AVX2
namespace clpv::bench::sweep_by_hand {
namespace {

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
CLPV_AVX2 void open_plane(const Swept& p, const Bin& bin, int plane, float* open) {
  const Ways& ways = p.ways[Swept::group_of(bin)];
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

/// A plane across y or z of the volumes from those on.
View view_of(const Swept& p, const Bin& bin, const float* injected, float* sums, int plane) {
  const Shape& s = p.shape;
  const std::ptrdiff_t step = bin.axis == 1 ? s.row() : s.slice(), row = bin.axis == 1 ? s.slice() : s.row();
  return {injected + plane * step, sums + plane * step, row, bin.plane_sign * step,
          kSweepBins * s.volume(), p.sum_channel(),     {},  s.row()};
}

/// The same across x: out of eight planes that have been turned.
View turned_view(const Swept& p, const Scratch& scratch, int number, int plane) {
  const Shape& s = p.shape;
  const std::ptrdiff_t eight = kLane * s.slice(), from = plane % kLane * s.slice();
  float* sources = scratch.sources.data() + number * kChannels * eight + from;
  return {sources, p.blocks ? sources : scratch.sums.data() + from, s.row(), 0, eight, eight, {}, s.row()};
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

}  // namespace

CLPV_AVX2 void turn_corners(const Swept& p, int z) {
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

CLPV_AVX2 void sweep_alike(const Swept& p, const int* numbers, int count, int channel, Scratch& scratch) {
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

CLPV_AVX2 void collect(const Swept& p, int axis, const float* sums, int channel, int z) {
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

}  // namespace clpv::bench::sweep_by_hand
#endif
