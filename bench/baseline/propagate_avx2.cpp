// SPDX-License-Identifier: MIT
#include "bench/baseline/propagate_avx2.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

#include "support/error.hpp"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define CLPV_HAS_AVX2 1
// By function and not by file: templates shared with other files must run on every processor.
#define CLPV_AVX2 __attribute__((target("avx2,fma")))
#else
#define CLPV_HAS_AVX2 0
#endif

namespace clpv::bench {

bool baseline_supported() {
#if CLPV_HAS_AVX2
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

#if CLPV_HAS_AVX2

namespace {

constexpr int kLane = 8;  ///< floats in a vector

/// Floats on 64-byte boundaries, 0 at first.
class Plane {
 public:
  explicit Plane(std::size_t count)
      : count_(count), values_(static_cast<float*>(std::aligned_alloc(64, bytes()))) {
    if (!values_) throw std::bad_alloc();
    clear();
  }
  float* data() const { return values_.get(); }
  void clear() { std::memset(data(), 0, bytes()); }
  std::size_t bytes() const { return (count_ * sizeof(float) + 63) / 64 * 64; }

 private:
  struct Free {
    void operator()(float* p) const { std::free(p); }
  };
  std::size_t count_;
  std::unique_ptr<float, Free> values_;
};

constexpr int kN = 4, kChannels = 3, kLinks = 30, kCorners = 8;
constexpr double kSame = 1e-9;  // of constants that are equal but for rounding in double

/// Rows of n cells between borders of kLane zeros, slices of n rows between borders of one row, and so on.
struct Shape {
  int n;
  std::ptrdiff_t row() const { return n + 2 * kLane; }
  std::ptrdiff_t slice() const { return row() * (n + 2); }
  std::ptrdiff_t plane() const { return slice() * (n + 2); }
  std::ptrdiff_t at(int x, int y, int z) const { return (z + 1) * slice() + (y + 1) * row() + x + kLane; }
};

/// What a neighbour sends: through its far face far0 c0 + far1 c_a, through side faces side0 c0 + side1 c_a +- g c_b.
struct Sent {
  float far0, far1, side0, side1, across;
};

/// Constants of sh2's step, and which coefficient goes with which axis.
struct Constants {
  int of_axis[3];  // index of the coefficient along x, y, z
  Sent sent[6];
  float lobe0, lobe1[3];  // a face's lobe: c0, and c_a by the sign of its normal
};

void require(bool fits) {
  if (!fits)
    throw Error(ExitCode::run_time, "baseline: made for sh2 with faces, whose constants these are not");
}

bool same(double a, double b) {
  return std::abs(a - b) < kSame;
}

Constants constants_of(const Basis& basis, const Transport& transport) {
  const auto* faces = std::get_if<FaceTransport>(&transport.scheme);
  require(faces != nullptr && basis.size() == kN);
  Constants c{};
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 1; i < kN; ++i) {
      if (std::abs(faces->lobes(i, 2 * axis)) > kSame) c.of_axis[axis] = i;
    }
    require(c.of_axis[axis] > 0 &&
            same(faces->lobes(c.of_axis[axis], 2 * axis), -faces->lobes(c.of_axis[axis], 2 * axis + 1)));
    c.lobe1[axis] = static_cast<float>(faces->lobes(c.of_axis[axis], 2 * axis));
  }
  c.lobe0 = static_cast<float>(faces->lobes(0, 0));
  for (int k = 0; k < 6; ++k) {
    const std::vector<double>& far = faces->faces[5 * k].flux;
    const auto along = static_cast<std::size_t>(c.of_axis[k / 2]);
    Sent& sent = c.sent[k];
    sent.far0 = static_cast<float>(far[0]), sent.far1 = static_cast<float>(far[along]);
    for (int f = 1; f < 5; ++f) {
      const Face& face = faces->faces[5 * k + f];
      const int axis = face.normal.x != 0 ? 0 : face.normal.y != 0 ? 1 : 2;
      const int sign = face.normal[axis];
      const double across = sign * face.flux[c.of_axis[axis]];
      require(f == 1 || (same(face.flux[0], sent.side0) || std::abs(face.flux[0] - sent.side0) < 1e-6));
      sent.side0 = static_cast<float>(face.flux[0]), sent.side1 = static_cast<float>(face.flux[along]);
      require(f == 1 || std::abs(across - sent.across) < 1e-6);
      sent.across = static_cast<float>(across);
    }
  }
  return c;
}

/// The link (index of FaceTransport::faces) through neighbour k's face of normal 2 axis + negative.
struct FaceTable {
  int link[6][6];
  glm::dvec3 against[kLinks];  // the direction its blocker is looked up in
  glm::ivec3 side[kLinks];
};

FaceTable links_of(const FaceTransport& faces) {
  FaceTable table{};
  for (int f = 0; f < kLinks; ++f) {
    const Face& face = faces.faces[f];
    const auto normal = std::find(kAxes.begin(), kAxes.end(), face.normal) - kAxes.begin();
    table.link[f / 5][normal] = f;
    table.against[f] = -face.direction;
    table.side[f] = face.normal;
  }
  return table;
}

}  // namespace

struct PropagateBaseline::Impl {
  Shape shape;
  Constants constants;
  FaceTable links;
  float blocker[kLinks][kN];  // basis functions in the link's direction, over the number of corners
  bool blocks = false;
  Plane injected, first, second, sum;  // 12 planes each
  Plane corners;                       // 4 planes of n + 1 samples, in rows as wide as the cells'
  Plane open;                          // 30 planes of n^3: share let through

  Impl(const Basis& basis, const Transport& transport, int grid)
      : shape{grid},
        constants(constants_of(basis, transport)),
        links(links_of(std::get<FaceTransport>(transport.scheme))),
        injected(planes()),
        first(planes()),
        second(planes()),
        sum(planes()),
        corners(static_cast<std::size_t>(shape.plane()) * kN),
        open(static_cast<std::size_t>(grid) * grid * grid * kLinks) {
    for (int w = 0; w < kLinks; ++w) {
      const std::vector<double> b = basis.evaluate(links.against[w]);
      for (int i = 0; i < kN; ++i) blocker[w][i] = static_cast<float>(b[i] / 4);
    }
  }
  std::size_t planes() const { return static_cast<std::size_t>(shape.plane()) * kChannels * kN; }
  std::ptrdiff_t cells() const { return std::ptrdiff_t{shape.n} * shape.n * shape.n; }
};

namespace {

using Impl = PropagateBaseline::Impl;

/// A face's share of light, let through where something blocks.
template <bool kBlocked>
CLPV_AVX2 inline __m256 through(__m256 flux, const float* open) {
  const __m256 positive = _mm256_max_ps(flux, _mm256_setzero_ps());
  if constexpr (kBlocked) return _mm256_mul_ps(positive, _mm256_load_ps(open));
  return positive;
}

/// Adds what neighbour kK sends to the six sums, of the eight cells at `at`.
template <bool kBlocked, int kK>
CLPV_AVX2 inline void receive(const Impl& p, const float* from, std::ptrdiff_t at, const float* open,
                              __m256 (&sums)[6]) {
  constexpr int kAxis = kK / 2, kB = (kAxis + 1) % 3, kC = (kAxis + 2) % 3;
  const Shape& s = p.shape;
  const std::ptrdiff_t steps[3] = {1, s.row(), s.slice()}, plane = s.plane(), cells = p.cells();
  const float* cell = from + at + (kK % 2 == 0 ? -steps[kAxis] : steps[kAxis]);
  const Sent& sent = p.constants.sent[kK];
  const __m256 c0 = _mm256_loadu_ps(cell), ca = _mm256_loadu_ps(cell + p.constants.of_axis[kAxis] * plane);
  const __m256 cb = _mm256_loadu_ps(cell + p.constants.of_axis[kB] * plane),
               cc = _mm256_loadu_ps(cell + p.constants.of_axis[kC] * plane);
  const auto link = [&](int normal) { return kBlocked ? open + p.links.link[kK][normal] * cells : nullptr; };
  const auto add = [&](int normal, __m256 flux) CLPV_AVX2 {
    sums[normal] = _mm256_add_ps(sums[normal], through<kBlocked>(flux, link(normal)));
  };
  add(kK, _mm256_fmadd_ps(_mm256_set1_ps(sent.far1), ca, _mm256_mul_ps(_mm256_set1_ps(sent.far0), c0)));
  const __m256 side =
      _mm256_fmadd_ps(_mm256_set1_ps(sent.side1), ca, _mm256_mul_ps(_mm256_set1_ps(sent.side0), c0));
  const __m256 across = _mm256_set1_ps(sent.across);
  add(2 * kB, _mm256_fmadd_ps(across, cb, side));
  add(2 * kB + 1, _mm256_fnmadd_ps(across, cb, side));
  add(2 * kC, _mm256_fmadd_ps(across, cc, side));
  add(2 * kC + 1, _mm256_fnmadd_ps(across, cc, side));
}

/// A row of one channel: what its cells gain, stored and added to the sum.
template <bool kBlocked>
CLPV_AVX2 void step_row(const Impl& p, const float* from, float* to, const float* so_far, float* sum, int y,
                        int z) {
  const Shape& s = p.shape;
  const std::ptrdiff_t plane = s.plane();
  for (int x = 0; x < s.n; x += kLane) {
    const std::ptrdiff_t at = s.at(x, y, z);
    const float* open = p.open.data() + (std::ptrdiff_t{z} * s.n + y) * s.n + x;
    __m256 sums[6];
    for (__m256& value : sums) value = _mm256_setzero_ps();
    receive<kBlocked, 0>(p, from, at, open, sums);
    receive<kBlocked, 1>(p, from, at, open, sums);
    receive<kBlocked, 2>(p, from, at, open, sums);
    receive<kBlocked, 3>(p, from, at, open, sums);
    receive<kBlocked, 4>(p, from, at, open, sums);
    receive<kBlocked, 5>(p, from, at, open, sums);
    const __m256 all =
        _mm256_add_ps(_mm256_add_ps(_mm256_add_ps(sums[0], sums[1]), _mm256_add_ps(sums[2], sums[3])),
                      _mm256_add_ps(sums[4], sums[5]));
    const auto give = [&](std::ptrdiff_t i, __m256 gained) CLPV_AVX2 {
      _mm256_store_ps(to + at + i * plane, gained);
      _mm256_store_ps(sum + at + i * plane, _mm256_add_ps(gained, _mm256_load_ps(so_far + at + i * plane)));
    };
    give(0, _mm256_mul_ps(_mm256_set1_ps(p.constants.lobe0), all));
    for (int a = 0; a < 3; ++a) {
      give(p.constants.of_axis[a],
           _mm256_mul_ps(_mm256_set1_ps(p.constants.lobe1[a]), _mm256_sub_ps(sums[2 * a], sums[2 * a + 1])));
    }
  }
}

template <bool kBlocked>
void step(const Impl& p, const float* from, float* to, const float* so_far) {
  const int n = p.shape.n;
#pragma omp parallel for schedule(static)
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int channel = 0; channel < kChannels; ++channel) {  // innermost: they share what blocks
        const std::ptrdiff_t of = channel * kN * p.shape.plane();
        step_row<kBlocked>(p, from + of, to + of, so_far + of, p.sum.data() + of, y, z);
      }
    }
  }
}

/// 1 - B of every link into the cells of a row.
CLPV_AVX2 void open_row(const Impl& p, int y, int z) {
  const Shape& s = p.shape;
  const __m256 one = _mm256_set1_ps(1.0f), zero = _mm256_setzero_ps();
  for (int x = 0; x < s.n; x += kLane) {
    __m256 mean[6][kN];  // sums over the four corners towards +x -x +y ...
    for (int i = 0; i < kN; ++i) {
      __m256 corner[kCorners];
      for (int c = 0; c < kCorners; ++c) {
        corner[c] = _mm256_loadu_ps(p.corners.data() + i * s.plane() +
                                    s.at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)));
      }
      for (int side = 0; side < 6; ++side) {
        __m256 sum = zero;
        for (int c = 0; c < kCorners; ++c) {
          if ((c >> side / 2 & 1) == (side % 2 == 0 ? 1 : 0)) sum = _mm256_add_ps(sum, corner[c]);
        }
        mean[side][i] = sum;
      }
    }
    for (int w = 0; w < kLinks; ++w) {
      const glm::ivec3& normal = p.links.side[w];
      const int axis = normal.x != 0   ? 0
                       : normal.y != 0 ? 1
                                       : 2,
                side = 2 * axis + (normal[axis] < 0 ? 1 : 0);
      __m256 b = _mm256_mul_ps(_mm256_set1_ps(p.blocker[w][0]), mean[side][0]);
      for (int i = 1; i < kN; ++i) b = _mm256_fmadd_ps(_mm256_set1_ps(p.blocker[w][i]), mean[side][i], b);
      const __m256 open = _mm256_sub_ps(one, _mm256_min_ps(one, _mm256_max_ps(zero, b)));
      _mm256_store_ps(p.open.data() + w * p.cells() + (std::ptrdiff_t{z} * s.n + y) * s.n + x, open);
    }
  }
}

void open_links(const Impl& p) {
  const int n = p.shape.n;
#pragma omp parallel for schedule(static)
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) open_row(p, y, z);
  }
}

// Operations by hand, as written above, a cell (and channel).
constexpr double kFluxFlops = 6 * (3 + 3 + 4 * 2 + 5), kSumFlops = 24, kLobeFlops = 5 + 1 + 3 * 2,
                 kAddFlops = 4;
constexpr double kOpenFlops = kN * 6 * 3 + kLinks * (1 + 3 * 2 + 3);

}  // namespace

PropagateBaseline::PropagateBaseline(const Basis& basis, const Transport& transport, int grid) {
  if (grid % kLane != 0)
    throw Error(ExitCode::run_time, "baseline: grid {}; allowed: multiples of {}", grid, kLane);
  impl_ = std::make_unique<Impl>(basis, transport, grid);
}

void PropagateBaseline::set(const std::vector<float>& injected, const std::vector<float>* geometry) {
  Impl& p = *impl_;
  const int n = p.shape.n;
  const auto rows = [&](const std::vector<float>& values, float* to, int planes, int side) {
    std::size_t at = 0;
    for (int plane = 0; plane < planes; ++plane) {
      for (int z = 0; z < side; ++z) {
        for (int y = 0; y < side; ++y, at += static_cast<std::size_t>(side)) {
          std::copy_n(values.data() + at, side, to + plane * p.shape.plane() + p.shape.at(0, y, z));
        }
      }
    }
  };
  rows(injected, p.injected.data(), kChannels * kN, n);
  p.blocks = geometry != nullptr;
  if (p.blocks) rows(*geometry, p.corners.data(), kN, n + 1);
}

void PropagateBaseline::propagate(int iterations) {
  Impl& p = *impl_;
  if (p.blocks && iterations > 1) open_links(p);
  const float* from = p.injected.data();
  if (iterations == 0) std::copy_n(from, p.planes(), p.sum.data());
  for (int i = 1; i <= iterations; ++i) {
    float* to = (i % 2 == 1 ? p.first : p.second).data();
    const float* so_far = i == 1 ? p.injected.data() : p.sum.data();
    if (p.blocks && i > 1) {
      step<true>(p, from, to, so_far);
    } else {
      step<false>(p, from, to, so_far);
    }
    from = to;
  }
}

std::vector<float> PropagateBaseline::accumulated() const {
  const Impl& p = *impl_;
  std::vector<float> values;
  for (int plane = 0; plane < kChannels * kN; ++plane) {
    for (int z = 0; z < p.shape.n; ++z) {
      for (int y = 0; y < p.shape.n; ++y) {
        const float* row = p.sum.data() + plane * p.shape.plane() + p.shape.at(0, y, z);
        values.insert(values.end(), row, row + p.shape.n);
      }
    }
  }
  return values;
}

double PropagateBaseline::flops(int iterations) const {
  const auto cells = static_cast<double>(impl_->cells());
  const double blocked = impl_->blocks ? iterations - 1 : 0;
  return cells * (iterations * kChannels * (kFluxFlops + kSumFlops + kLobeFlops + kAddFlops) +
                  blocked * kChannels * kLinks + (impl_->blocks ? kOpenFlops : 0));
}

double PropagateBaseline::bytes(int iterations) const {
  const auto cells = static_cast<double>(impl_->cells());
  const double step = kChannels * 4.0 * kN, blocked = impl_->blocks ? iterations : 0;
  return sizeof(float) * cells *
         (iterations * step - kChannels * kN + blocked * kLinks + (impl_->blocks ? kN : 0));
}

#else  // no AVX2 on this architecture

struct PropagateBaseline::Impl {};
PropagateBaseline::PropagateBaseline(const Basis&, const Transport&, int) {
  throw Error(ExitCode::run_time, "baseline: needs a processor with AVX2");
}
void PropagateBaseline::set(const std::vector<float>&, const std::vector<float>*) {}
void PropagateBaseline::propagate(int) {}
std::vector<float> PropagateBaseline::accumulated() const {
  return {};
}
double PropagateBaseline::flops(int) const {
  return 0;
}
double PropagateBaseline::bytes(int) const {
  return 0;
}

#endif

PropagateBaseline::~PropagateBaseline() = default;

}  // namespace clpv::bench
