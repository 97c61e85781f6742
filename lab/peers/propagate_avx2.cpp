// SPDX-License-Identifier: MIT
// Propagation of sh2 by vectors of eight cells. A cell takes from each of its 6 neighbours the flux
// through the neighbour's far face and 4 side faces, and reprojects it as a lobe. Kaplanyan and
// Dachsbacher, 'Cascaded Light Propagation Volumes for Real-Time Indirect Illumination' (I3D 2010).
#include "peers/propagate_avx2.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <new>

#include "support/error.hpp"

// The target is set per function and not per file: shared templates must run on every processor.
#if defined(__x86_64__)
#define CLPV_AVX2 __attribute__((target("avx2,fma")))
#else
#define CLPV_AVX2
#endif

namespace clpv::bench {
namespace {

constexpr int kLane = 8;  ///< floats in a vector
using Lanes = float __attribute__((vector_size(4 * kLane)));
using UnalignedLanes = float __attribute__((vector_size(4 * kLane), aligned(4), may_alias));

CLPV_AVX2 inline Lanes load(const float* from) {
  return *reinterpret_cast<const UnalignedLanes*>(from);
}
CLPV_AVX2 inline void store(Lanes value, float* to) {
  *reinterpret_cast<UnalignedLanes*>(to) = value;
}

CLPV_AVX2 inline Lanes positive_part(Lanes v) {
#if defined(__x86_64__)
  return __builtin_ia32_maxps256(v, Lanes{});  // GCC 12 compiles the comparison to two instructions
#else
  return v > 0.0f ? v : Lanes{};
#endif
}

/// `count` floats aligned to 64 bytes, initially 0.
using Plane = std::unique_ptr<float, decltype(&std::free)>;
Plane make_plane(std::size_t count) {
  const std::size_t bytes = (count * sizeof(float) + 63) / 64 * 64;
  Plane plane(static_cast<float*>(std::aligned_alloc(64, bytes)), &std::free);
  if (!plane) throw std::bad_alloc();
  std::memset(plane.get(), 0, bytes);
  return plane;
}

constexpr int kN = 4, kChannels = 3, kLinks = 30, kCorners = 8;

/// Layout of a plane of n^3 cells with a border of zeros: kLane cells before and after a row, one
/// row, one slice.
struct PlaneLayout {
  int n;
  std::ptrdiff_t row() const { return n + 2 * kLane; }
  std::ptrdiff_t slice() const { return row() * (n + 2); }
  std::ptrdiff_t plane() const { return slice() * (n + 2); }
  std::ptrdiff_t at(int x, int y, int z) const {
    return (z + 1) * slice() + (y + 1) * row() + x + kLane;
  }
};

/// Constants of a step in sh2. From a neighbour along axis a, far0 c0 + far1 c_a travels through
/// its far face, and side0 c0 + side1 c_a +- across c_b through its side faces of normal +-b.
struct Constants {
  int coefficient[3];  // index of the coefficient along x, y, z
  struct {
    float far0, far1, side0, side1, across;
  } flux[6];              // by neighbour
  float lobe0, lobe1[3];  // a face's lobe: c0, and c_a by the sign of its normal
};

int axis_of(const glm::ivec3& normal) {
  return normal.x != 0 ? 0 : normal.y != 0 ? 1 : 2;
}

Constants constants_of(const FaceTransport& faces) {
  Constants c{};
  c.lobe0 = static_cast<float>(faces.lobes(0, 0));
  for (int axis = 0; axis < 3; ++axis) {
    int& i = c.coefficient[axis] = 1;
    for (int j = 2; j < kN; ++j)
      if (std::abs(faces.lobes(j, 2 * axis)) > std::abs(faces.lobes(i, 2 * axis))) i = j;
    c.lobe1[axis] = static_cast<float>(faces.lobes(i, 2 * axis));
  }
  for (int k = 0; k < 6; ++k) {
    const std::vector<double>& far = faces.faces[5 * k].flux;
    const Face& side = faces.faces[5 * k + 1];
    const int along = c.coefficient[k / 2], b = axis_of(side.normal);
    const double flux[] = {far[0], far[along], side.flux[0], side.flux[along],
                           side.normal[b] * side.flux[c.coefficient[b]]};
    float* const to[] = {&c.flux[k].far0, &c.flux[k].far1, &c.flux[k].side0, &c.flux[k].side1,
                         &c.flux[k].across};
    for (int i = 0; i < 5; ++i) *to[i] = static_cast<float>(flux[i]);
  }
  return c;
}

const FaceTransport& faces_of(const Basis& basis, const Transport& transport) {
  const auto* faces = std::get_if<FaceTransport>(&transport.scheme);
  if (faces == nullptr || basis.size() != kN)
    throw Error(ExitCode::run_time,
                "native: unsupported basis or transport; allowed: sh2, face transport");
  return *faces;
}

}  // namespace

struct PropagateAvx2::Impl {
  PlaneLayout layout;
  Constants constants;
  int link[6][6];    // index of FaceTransport::faces by neighbour and face: 2 axis + (normal < 0)
  int side[kLinks];  // the face that a link passes
  float blocker[kLinks]
               [kN];  // basis functions against the light, over the number of corners of a face
  bool occlusion = false;
  std::size_t planes = static_cast<std::size_t>(layout.plane()) * kChannels * kN;
  std::ptrdiff_t cells = std::ptrdiff_t{layout.n} * layout.n * layout.n;
  Plane injected = make_plane(planes), first = make_plane(planes), second = make_plane(planes),
        sum = make_plane(planes);
  // (n + 1)^3 samples, as cells.
  Plane corners = make_plane(static_cast<std::size_t>(layout.plane()) * kN);
  Plane transmittance = make_plane(static_cast<std::size_t>(cells) * kLinks);

  Impl(const Basis& basis, const FaceTransport& faces, int grid)
      : layout{grid}, constants(constants_of(faces)) {
    for (int f = 0; f < kLinks; ++f) {
      const glm::ivec3& normal = faces.faces[f].normal;
      side[f] = 2 * axis_of(normal) + (normal[axis_of(normal)] < 0 ? 1 : 0);
      link[f / 5][side[f]] = f;
      const std::vector<double> b = basis.evaluate(-faces.faces[f].direction);
      for (int i = 0; i < kN; ++i) blocker[f][i] = static_cast<float>(b[i] / 4);
    }
  }
};

namespace {

using Impl = PropagateAvx2::Impl;

/// Adds the flux from neighbour k to the sums of the six faces, for the eight cells at `at`.
template <bool kOcclusion>
CLPV_AVX2 inline void receive(const Impl& p, const int k, const float* from, std::ptrdiff_t at,
                              const float* transmittance, Lanes (&sums)[6]) {
  const int a = k / 2, b = (a + 1) % 3, c = (a + 2) % 3;
  const PlaneLayout& s = p.layout;
  const std::ptrdiff_t steps[3] = {1, s.row(), s.slice()}, plane = s.plane();
  const float* cell = from + at + (k % 2 == 0 ? -steps[a] : steps[a]);
  const auto& weights = p.constants.flux[k];
  const int* coefficient = p.constants.coefficient;
  const Lanes c0 = load(cell), ca = load(cell + coefficient[a] * plane);
  const Lanes cb = weights.across * load(cell + coefficient[b] * plane),
              cc = weights.across * load(cell + coefficient[c] * plane);
  const auto add = [&](int normal, Lanes flux) CLPV_AVX2 {
    Lanes through = positive_part(flux);
    if (kOcclusion) through *= load(transmittance + p.link[k][normal] * p.cells);
    sums[normal] += through;
  };
  add(k, weights.far0 * c0 + weights.far1 * ca);
  const Lanes side = weights.side0 * c0 + weights.side1 * ca;
  add(2 * b, side + cb), add(2 * b + 1, side - cb);
  add(2 * c, side + cc), add(2 * c + 1, side - cc);
}

/// A step of one row and channel: `to` = light propagated from `from`, and `sum` = `so_far` + `to`.
template <bool kOcclusion>
CLPV_AVX2 void step_row(const Impl& p, const float* from, float* to, const float* so_far,
                        float* sum, int y, int z) {
  const PlaneLayout& s = p.layout;
  for (int x = 0; x < s.n; x += kLane) {
    const std::ptrdiff_t at = s.at(x, y, z);
    const float* transmittance = p.transmittance.get() + (std::ptrdiff_t{z} * s.n + y) * s.n + x;
    Lanes sums[6] = {};
#pragma GCC unroll 6
    for (int k = 0; k < 6; ++k) receive<kOcclusion>(p, k, from, at, transmittance, sums);
    const auto gain = [&](int i, Lanes value) CLPV_AVX2 {
      const std::ptrdiff_t here = at + i * s.plane();
      store(value, to + here);
      store(value + load(so_far + here), sum + here);
    };
    gain(0, p.constants.lobe0 * ((sums[0] + sums[1]) + (sums[2] + sums[3]) + (sums[4] + sums[5])));
    for (int a = 0; a < 3; ++a)
      gain(p.constants.coefficient[a], p.constants.lobe1[a] * (sums[2 * a] - sums[2 * a + 1]));
  }
}

template <bool kOcclusion>
void step(const Impl& p, const float* from, float* to, const float* so_far) {
  const int n = p.layout.n;
#pragma omp parallel for schedule(static)
  for (int z = 0; z < n; ++z) {
    for (int y = 0; y < n; ++y) {
      for (int channel = 0; channel < kChannels;
           ++channel) {  // innermost: channels share transmittances
        const std::ptrdiff_t at = channel * kN * p.layout.plane();
        step_row<kOcclusion>(p, from + at, to + at, so_far + at, p.sum.get() + at, y, z);
      }
    }
  }
}

/// Transmittance 1 - B of every link into the cells of a row; B is the mean of the geometry volume
/// over the face's four corners, evaluated in the blocker's direction and clamped to [0, 1].
CLPV_AVX2 void transmittance_row(const Impl& p, int y, int z) {
  const PlaneLayout& s = p.layout;
  for (int x = 0; x < s.n; x += kLane) {
    Lanes sums[6][kN] = {};  // over the four corners of faces +x -x +y -y +z -z
    for (int i = 0; i < kN; ++i) {
      for (int c = 0; c < kCorners; ++c) {
        const Lanes corner = load(p.corners.get() + i * s.plane() +
                                  s.at(x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)));
        for (int a = 0; a < 3; ++a) sums[2 * a + (c >> a & 1 ? 0 : 1)][i] += corner;
      }
    }
    for (int w = 0; w < kLinks; ++w) {
      Lanes t = Lanes{} + 1.0f;
      for (int i = 0; i < kN; ++i) t -= p.blocker[w][i] * sums[p.side[w]][i];
      t = positive_part(t);
      store(t < 1.0f ? t : Lanes{} + 1.0f,
            p.transmittance.get() + w * p.cells + (std::ptrdiff_t{z} * s.n + y) * s.n + x);
    }
  }
}

// Operations of the code above, per cell; a step's per cell and channel.
constexpr double kFluxFlops = 6 * (3 + 3 + 4 * 2 + 5), kSumFlops = 24, kLobeFlops = 5 + 1 + 3 * 2,
                 kAddFlops = 4;
constexpr double kTransmittanceFlops = kN * 6 * 3 + kLinks * (1 + 3 * 2 + 3);

/// Calls visit(plane, y, z) for each row of `side` rows and planes, in the order of Volume's host
/// values.
template <typename Visit>
void for_each_row(int planes, int side, Visit visit) {
  for (int plane = 0; plane < planes; ++plane)
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y) visit(plane, y, z);
}

void copy(const std::vector<double>& values, const PlaneLayout& layout, float* to, int planes,
          int side) {
  auto from = values.begin();
  for_each_row(planes, side, [&](int plane, int y, int z) {
    std::copy_n(from, side, to + plane * layout.plane() + layout.at(0, y, z));
    from += side;
  });
}

}  // namespace

bool avx2_supported() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
  return false;
#endif
}

PropagateAvx2::PropagateAvx2(const Basis& basis, const Transport& transport, int grid) {
  if (grid % kLane != 0)
    throw Error(ExitCode::run_time, "native: grid {}; allowed: multiples of {}", grid, kLane);
  impl_ = std::make_unique<Impl>(basis, faces_of(basis, transport), grid);
}

PropagateAvx2::~PropagateAvx2() = default;

void PropagateAvx2::set(const std::vector<double>& injected, const std::vector<double>* geometry) {
  Impl& p = *impl_;
  copy(injected, p.layout, p.injected.get(), kChannels * kN, p.layout.n);
  p.occlusion = geometry != nullptr;
  if (p.occlusion) copy(*geometry, p.layout, p.corners.get(), kN, p.layout.n + 1);
}

void PropagateAvx2::propagate(int iterations) {
  const Impl& p = *impl_;
  const int n = p.layout.n;
  const float* from = p.injected.get();
  if (iterations == 0) std::copy_n(from, p.planes, p.sum.get());
  if (p.occlusion && iterations > 1) {
#pragma omp parallel for schedule(static)
    for (int z = 0; z < n; ++z) {
      for (int y = 0; y < n; ++y) transmittance_row(p, y, z);
    }
  }
  for (int i = 1; i <= iterations; ++i) {
    float* to = (i % 2 == 1 ? p.first : p.second).get();
    (p.occlusion && i > 1 ? step<true> : step<false>)(p, from, to, i == 1 ? from : p.sum.get());
    from = to;
  }
}

std::vector<float> PropagateAvx2::accumulated() const {
  const PlaneLayout& layout = impl_->layout;
  std::vector<float> values;
  for_each_row(kChannels * kN, layout.n, [&](int plane, int y, int z) {
    const float* row = impl_->sum.get() + plane * layout.plane() + layout.at(0, y, z);
    values.insert(values.end(), row, row + layout.n);
  });
  return values;
}

double PropagateAvx2::flops(int iterations) const {
  const double occluded_steps = impl_->occlusion ? iterations - 1 : 0;
  return static_cast<double>(impl_->cells) *
         (iterations * kChannels * (kFluxFlops + kSumFlops + kLobeFlops + kAddFlops) +
          occluded_steps * kChannels * kLinks + (impl_->occlusion ? kTransmittanceFlops : 0));
}

double PropagateAvx2::bytes(int iterations) const {
  const double step = kChannels * 4.0 * kN,
               // Written once, read after the first step.
      transmittances = impl_->occlusion ? kLinks * iterations : 0;
  return sizeof(float) * static_cast<double>(impl_->cells) *
         (iterations * step - kChannels * kN + transmittances + (impl_->occlusion ? kN : 0));
}

}  // namespace clpv::bench
