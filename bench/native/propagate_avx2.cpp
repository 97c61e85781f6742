// SPDX-License-Identifier: MIT
// Propagation of sh2 by intrinsics. A cell takes from each of its 6 neighbours the flux through the neighbour's far face
// and 4 side faces, and reprojects it as a lobe. Kaplanyan and Dachsbacher, 'Cascaded Light Propagation Volumes for
// Real-Time Indirect Illumination' (I3D 2010).
#include "bench/native/propagate_avx2.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

#include "support/error.hpp"

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define CLPV_HAS_AVX2 1
// The target is set per function and not per file: shared templates must run on every processor.
#define CLPV_AVX2 __attribute__((target("avx2,fma")))
#else
#define CLPV_HAS_AVX2 0
#endif

namespace clpv::bench {

bool avx2_supported() {
#if CLPV_HAS_AVX2
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

#if CLPV_HAS_AVX2

namespace {

constexpr int kLane = 8;  ///< floats in a vector

/// Floats aligned to 64 bytes, initially 0.
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
constexpr double kRounding = 1e-9;  // tolerance for constants that are equal up to rounding in double

/// Layout of a plane of n^3 cells with a border of zeros: kLane cells before and after a row, one row, one slice.
struct PlaneLayout {
  int n;
  std::ptrdiff_t row() const { return n + 2 * kLane; }
  std::ptrdiff_t slice() const { return row() * (n + 2); }
  std::ptrdiff_t plane() const { return slice() * (n + 2); }
  std::ptrdiff_t at(int x, int y, int z) const { return (z + 1) * slice() + (y + 1) * row() + x + kLane; }
};

/// Weights of the flux from a neighbour along axis a: far0 c0 + far1 c_a through its far face, and
/// side0 c0 + side1 c_a +- across c_b through its side faces of normal +-b.
struct FluxWeights {
  float far0, far1, side0, side1, across;
};

/// Constants of a step in sh2.
struct Constants {
  int axis_coefficient[3];  // index of the coefficient along x, y, z
  FluxWeights flux[6];      // by neighbour
  float lobe0, lobe1[3];    // a face's lobe: c0, and c_a by the sign of its normal
};

void require(bool supported) {
  if (!supported)
    throw Error(ExitCode::run_time, "native: unsupported basis or transport; allowed: sh2, face transport");
}

bool equal(double a, double b) {
  return std::abs(a - b) < kRounding;
}

Constants constants_of(const Basis& basis, const Transport& transport) {
  const auto* faces = std::get_if<FaceTransport>(&transport.scheme);
  require(faces != nullptr && basis.size() == kN);
  Constants c{};
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 1; i < kN; ++i) {
      if (std::abs(faces->lobes(i, 2 * axis)) > kRounding) c.axis_coefficient[axis] = i;
    }
    const int i = c.axis_coefficient[axis];
    require(i > 0 && equal(faces->lobes(i, 2 * axis), -faces->lobes(i, 2 * axis + 1)));
    c.lobe1[axis] = static_cast<float>(faces->lobes(i, 2 * axis));
  }
  c.lobe0 = static_cast<float>(faces->lobes(0, 0));
  for (int k = 0; k < 6; ++k) {
    const std::vector<double>& far = faces->faces[5 * k].flux;
    const auto along = static_cast<std::size_t>(c.axis_coefficient[k / 2]);
    FluxWeights& weights = c.flux[k];
    weights.far0 = static_cast<float>(far[0]), weights.far1 = static_cast<float>(far[along]);
    for (int f = 1; f < 5; ++f) {
      const Face& face = faces->faces[5 * k + f];
      const int axis = face.normal.x != 0 ? 0 : face.normal.y != 0 ? 1 : 2;
      const int sign = face.normal[axis];
      const double across = sign * face.flux[c.axis_coefficient[axis]];
      require(f == 1 || std::abs(face.flux[0] - weights.side0) < 1e-6);
      weights.side0 = static_cast<float>(face.flux[0]), weights.side1 = static_cast<float>(face.flux[along]);
      require(f == 1 || std::abs(across - weights.across) < 1e-6);
      weights.across = static_cast<float>(across);
    }
  }
  return c;
}

/// Links by neighbour and face. A link is an index of FaceTransport::faces; a face has the index 2 axis + (normal < 0).
struct FaceTable {
  int link[6][6];                        // by neighbour and face
  glm::dvec3 blocker_direction[kLinks];  // against the light
  glm::ivec3 normal[kLinks];
};

FaceTable links_of(const FaceTransport& faces) {
  FaceTable table{};
  for (int f = 0; f < kLinks; ++f) {
    const Face& face = faces.faces[f];
    const auto normal = std::find(kAxes.begin(), kAxes.end(), face.normal) - kAxes.begin();
    table.link[f / 5][normal] = f;
    table.blocker_direction[f] = -face.direction;
    table.normal[f] = face.normal;
  }
  return table;
}

}  // namespace

struct PropagateAvx2::Impl {
  PlaneLayout layout;
  Constants constants;
  FaceTable links;
  float blocker[kLinks]
               [kN];  // basis functions in the blocker's direction, over the number of corners of a face
  bool occlusion = false;
  Plane injected, first, second, sum;  // 12 planes each
  Plane corners;                       // 4 planes of (n + 1)^3 samples, in the cells' layout
  Plane transmittance;                 // 30 planes of n^3, one per link

  Impl(const Basis& basis, const Transport& transport, int grid)
      : layout{grid},
        constants(constants_of(basis, transport)),
        links(links_of(std::get<FaceTransport>(transport.scheme))),
        injected(planes()),
        first(planes()),
        second(planes()),
        sum(planes()),
        corners(static_cast<std::size_t>(layout.plane()) * kN),
        transmittance(static_cast<std::size_t>(grid) * grid * grid * kLinks) {
    for (int w = 0; w < kLinks; ++w) {
      const std::vector<double> b = basis.evaluate(links.blocker_direction[w]);
      for (int i = 0; i < kN; ++i) blocker[w][i] = static_cast<float>(b[i] / 4);
    }
  }
  std::size_t planes() const { return static_cast<std::size_t>(layout.plane()) * kChannels * kN; }
  std::ptrdiff_t cells() const { return std::ptrdiff_t{layout.n} * layout.n * layout.n; }
};

namespace {

using Impl = PropagateAvx2::Impl;

/// Positive flux through a face, times the link's transmittance with occlusion.
template <bool kOcclusion>
CLPV_AVX2 inline __m256 transmitted(__m256 flux, const float* transmittance) {
  const __m256 positive = _mm256_max_ps(flux, _mm256_setzero_ps());
  if constexpr (kOcclusion) return _mm256_mul_ps(positive, _mm256_load_ps(transmittance));
  return positive;
}

/// Adds the flux from neighbour kK to the sums of the six faces, for the eight cells at `at`.
template <bool kOcclusion, int kK>
CLPV_AVX2 inline void receive(const Impl& p, const float* from, std::ptrdiff_t at, const float* transmittance,
                              __m256 (&sums)[6]) {
  constexpr int kAxis = kK / 2, kB = (kAxis + 1) % 3, kC = (kAxis + 2) % 3;
  const PlaneLayout& s = p.layout;
  const std::ptrdiff_t steps[3] = {1, s.row(), s.slice()}, plane = s.plane(), cells = p.cells();
  const float* cell = from + at + (kK % 2 == 0 ? -steps[kAxis] : steps[kAxis]);
  const FluxWeights& weights = p.constants.flux[kK];
  const int* coefficient = p.constants.axis_coefficient;
  const __m256 c0 = _mm256_loadu_ps(cell), ca = _mm256_loadu_ps(cell + coefficient[kAxis] * plane);
  const __m256 cb = _mm256_loadu_ps(cell + coefficient[kB] * plane),
               cc = _mm256_loadu_ps(cell + coefficient[kC] * plane);
  const auto link = [&](int normal) {
    return kOcclusion ? transmittance + p.links.link[kK][normal] * cells : nullptr;
  };
  const auto add = [&](int normal, __m256 flux) CLPV_AVX2 {
    sums[normal] = _mm256_add_ps(sums[normal], transmitted<kOcclusion>(flux, link(normal)));
  };
  add(kK, _mm256_fmadd_ps(_mm256_set1_ps(weights.far1), ca, _mm256_mul_ps(_mm256_set1_ps(weights.far0), c0)));
  const __m256 side =
      _mm256_fmadd_ps(_mm256_set1_ps(weights.side1), ca, _mm256_mul_ps(_mm256_set1_ps(weights.side0), c0));
  const __m256 across = _mm256_set1_ps(weights.across);
  add(2 * kB, _mm256_fmadd_ps(across, cb, side));
  add(2 * kB + 1, _mm256_fnmadd_ps(across, cb, side));
  add(2 * kC, _mm256_fmadd_ps(across, cc, side));
  add(2 * kC + 1, _mm256_fnmadd_ps(across, cc, side));
}

/// A step of one row and channel: `to` = light propagated from `from`, and `sum` = `so_far` + `to`.
template <bool kOcclusion>
CLPV_AVX2 void step_row(const Impl& p, const float* from, float* to, const float* so_far, float* sum, int y,
                        int z) {
  const PlaneLayout& s = p.layout;
  const std::ptrdiff_t plane = s.plane();
  for (int x = 0; x < s.n; x += kLane) {
    const std::ptrdiff_t at = s.at(x, y, z);
    const float* transmittance = p.transmittance.data() + (std::ptrdiff_t{z} * s.n + y) * s.n + x;
    __m256 sums[6];
    for (__m256& value : sums) value = _mm256_setzero_ps();
    receive<kOcclusion, 0>(p, from, at, transmittance, sums);
    receive<kOcclusion, 1>(p, from, at, transmittance, sums);
    receive<kOcclusion, 2>(p, from, at, transmittance, sums);
    receive<kOcclusion, 3>(p, from, at, transmittance, sums);
    receive<kOcclusion, 4>(p, from, at, transmittance, sums);
    receive<kOcclusion, 5>(p, from, at, transmittance, sums);
    const __m256 all =
        _mm256_add_ps(_mm256_add_ps(_mm256_add_ps(sums[0], sums[1]), _mm256_add_ps(sums[2], sums[3])),
                      _mm256_add_ps(sums[4], sums[5]));
    const auto store = [&](std::ptrdiff_t i, __m256 value) CLPV_AVX2 {
      _mm256_store_ps(to + at + i * plane, value);
      _mm256_store_ps(sum + at + i * plane, _mm256_add_ps(value, _mm256_load_ps(so_far + at + i * plane)));
    };
    store(0, _mm256_mul_ps(_mm256_set1_ps(p.constants.lobe0), all));
    for (int a = 0; a < 3; ++a) {
      store(p.constants.axis_coefficient[a],
            _mm256_mul_ps(_mm256_set1_ps(p.constants.lobe1[a]), _mm256_sub_ps(sums[2 * a], sums[2 * a + 1])));
    }
  }
}

template <bool kOcclusion>
void step(const Impl& p, const float* from, float* to, const float* so_far) {
  const int n = p.layout.n;
#pragma omp parallel for schedule(static)
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int channel = 0; channel < kChannels; ++channel) {  // innermost: channels share transmittances
        const std::ptrdiff_t offset = channel * kN * p.layout.plane();
        step_row<kOcclusion>(p, from + offset, to + offset, so_far + offset, p.sum.data() + offset, y, z);
      }
    }
  }
}

/// Transmittance 1 - B of every link into the cells of a row; B is the mean of the geometry volume over the face's four
/// corners, evaluated in the blocker's direction and clamped to [0, 1].
CLPV_AVX2 void transmittance_row(const Impl& p, int y, int z) {
  const PlaneLayout& s = p.layout;
  const __m256 one = _mm256_set1_ps(1.0f), zero = _mm256_setzero_ps();
  for (int x = 0; x < s.n; x += kLane) {
    __m256 corner_sum[6][kN];  // sums over the four corners of faces +x -x +y -y +z -z
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
        corner_sum[side][i] = sum;
      }
    }
    for (int w = 0; w < kLinks; ++w) {
      const glm::ivec3& normal = p.links.normal[w];
      const int axis = normal.x != 0   ? 0
                       : normal.y != 0 ? 1
                                       : 2,
                side = 2 * axis + (normal[axis] < 0 ? 1 : 0);
      __m256 b = _mm256_mul_ps(_mm256_set1_ps(p.blocker[w][0]), corner_sum[side][0]);
      for (int i = 1; i < kN; ++i)
        b = _mm256_fmadd_ps(_mm256_set1_ps(p.blocker[w][i]), corner_sum[side][i], b);
      const __m256 transmittance = _mm256_sub_ps(one, _mm256_min_ps(one, _mm256_max_ps(zero, b)));
      _mm256_store_ps(p.transmittance.data() + w * p.cells() + (std::ptrdiff_t{z} * s.n + y) * s.n + x,
                      transmittance);
    }
  }
}

void compute_transmittances(const Impl& p) {
  const int n = p.layout.n;
#pragma omp parallel for schedule(static)
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) transmittance_row(p, y, z);
  }
}

// Operations of the code above, per cell; a step's per cell and channel.
constexpr double kFluxFlops = 6 * (3 + 3 + 4 * 2 + 5), kSumFlops = 24, kLobeFlops = 5 + 1 + 3 * 2,
                 kAddFlops = 4;
constexpr double kTransmittanceFlops = kN * 6 * 3 + kLinks * (1 + 3 * 2 + 3);

}  // namespace

PropagateAvx2::PropagateAvx2(const Basis& basis, const Transport& transport, int grid) {
  if (grid % kLane != 0)
    throw Error(ExitCode::run_time, "native: grid {}; allowed: multiples of {}", grid, kLane);
  impl_ = std::make_unique<Impl>(basis, transport, grid);
}

void PropagateAvx2::set(const std::vector<double>& injected, const std::vector<double>* geometry) {
  Impl& p = *impl_;
  const int n = p.layout.n;
  const auto copy = [&](const std::vector<double>& values, float* to, int planes, int side) {
    std::size_t at = 0;
    for (int plane = 0; plane < planes; ++plane) {
      for (int z = 0; z < side; ++z) {
        for (int y = 0; y < side; ++y, at += static_cast<std::size_t>(side)) {
          std::copy_n(values.data() + at, side, to + plane * p.layout.plane() + p.layout.at(0, y, z));
        }
      }
    }
  };
  copy(injected, p.injected.data(), kChannels * kN, n);
  p.occlusion = geometry != nullptr;
  if (p.occlusion) copy(*geometry, p.corners.data(), kN, n + 1);
}

void PropagateAvx2::propagate(int iterations) {
  Impl& p = *impl_;
  if (p.occlusion && iterations > 1) compute_transmittances(p);
  const float* from = p.injected.data();
  if (iterations == 0) std::copy_n(from, p.planes(), p.sum.data());
  for (int i = 1; i <= iterations; ++i) {
    float* to = (i % 2 == 1 ? p.first : p.second).data();
    const float* so_far = i == 1 ? p.injected.data() : p.sum.data();
    if (p.occlusion && i > 1) {
      step<true>(p, from, to, so_far);
    } else {
      step<false>(p, from, to, so_far);
    }
    from = to;
  }
}

std::vector<float> PropagateAvx2::accumulated() const {
  const Impl& p = *impl_;
  std::vector<float> values;
  for (int plane = 0; plane < kChannels * kN; ++plane) {
    for (int z = 0; z < p.layout.n; ++z) {
      for (int y = 0; y < p.layout.n; ++y) {
        const float* row = p.sum.data() + plane * p.layout.plane() + p.layout.at(0, y, z);
        values.insert(values.end(), row, row + p.layout.n);
      }
    }
  }
  return values;
}

double PropagateAvx2::flops(int iterations) const {
  const auto cells = static_cast<double>(impl_->cells());
  const double occluded_steps = impl_->occlusion ? iterations - 1 : 0;
  return cells * (iterations * kChannels * (kFluxFlops + kSumFlops + kLobeFlops + kAddFlops) +
                  occluded_steps * kChannels * kLinks + (impl_->occlusion ? kTransmittanceFlops : 0));
}

double PropagateAvx2::bytes(int iterations) const {
  const auto cells = static_cast<double>(impl_->cells());
  const double step = kChannels * 4.0 * kN,
               transmittances =
                   impl_->occlusion ? kLinks * iterations : 0;  // written once, read after the first step
  return sizeof(float) * cells *
         (iterations * step - kChannels * kN + transmittances + (impl_->occlusion ? kN : 0));
}

#else  // other architectures

struct PropagateAvx2::Impl {};
PropagateAvx2::PropagateAvx2(const Basis&, const Transport&, int) {
  throw Error(ExitCode::run_time, "native: needs a processor with AVX2");
}
void PropagateAvx2::set(const std::vector<double>&, const std::vector<double>*) {}
void PropagateAvx2::propagate(int) {}
std::vector<float> PropagateAvx2::accumulated() const {
  return {};
}
double PropagateAvx2::flops(int) const {
  return 0;
}
double PropagateAvx2::bytes(int) const {
  return 0;
}

#endif

PropagateAvx2::~PropagateAvx2() = default;

}  // namespace clpv::bench
