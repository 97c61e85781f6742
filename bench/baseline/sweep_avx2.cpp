// SPDX-License-Identifier: MIT
#include "bench/baseline/sweep_avx2.hpp"

#include <algorithm>
#include <cmath>

#include "basis/sweep.hpp"
#include "bench/baseline/sweep_avx2_data.hpp"
#include "support/error.hpp"

namespace clpv::bench {

#if CLPV_HAS_AVX2

using namespace sweep_by_hand;

struct SweepBaseline::Impl : Swept {
  using Swept::Swept;
};

namespace {

// Operations by hand, as sweep_avx2_planes.cpp has them, a cell.
constexpr double kOpenFlops = 6 * (5 + 2 + 2 + 2 * (1 + 2 * 2 + 2 * 2 + 4 * 3) + kWays * 2);
constexpr double kCollectFlops = kChannels * (3 * (3 * kOctants + 2 * kKept) - kKept);

}  // namespace

SweepBaseline::SweepBaseline(const Basis& basis, const Transport& transport, int grid, int parts) {
  if (grid % kLane != 0)
    throw Error(ExitCode::run_time, "baseline: grid {}; allowed: multiples of {}", grid, kLane);
  require(holds_bin_means(basis));
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
