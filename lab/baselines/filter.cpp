// SPDX-License-Identifier: MIT
// The filter's inner loop runs along a row, one tap at a time, so that compilers vectorise it.
#include "baselines/filter.hpp"

#include <cmath>
#include <cstdlib>

// Compile a function for the processor's widest vectors, as OpenCL drivers do with kernels, and a
// loop whose iterations do not depend on each other. Sanitizers do not support it.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define CLPV_WIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#define CLPV_INDEPENDENT _Pragma("GCC ivdep")
#else
#define CLPV_WIDE
#define CLPV_INDEPENDENT
#endif

namespace clpv::baselines {
namespace {

// Distance of planes at which a tap's weight is 0, in pixel edges per pixel of distance. Tuned,
// like the power of the normals' cosine, on Sponza, the atrium and the Cornell box with two paths
// per pixel.
constexpr float kThickness = 2;

/// A range of a row's pixels.
struct Row {
  const float *px, *py, *pz, *nx, *ny, *nz, *density;
  const float *red, *green, *blue, *computed;
};

Row row_at(const Planes& surfaces, const Irradiance& image, std::size_t i) {
  return {surfaces[kPosition] + i,
          surfaces[kPosition + 1] + i,
          surfaces[kPosition + 2] + i,
          surfaces[kNormal] + i,
          surfaces[kNormal + 1] + i,
          surfaces[kNormal + 2] + i,
          surfaces[kDensity] + i,
          image[0] + i,
          image[1] + i,
          image[2] + i,
          image[3] + i};
}

/// Adds the weighted irradiance of `count` pixels `b` to the sums of pixels `a`, and the weights to
/// the fourth. A weight is `share` cos^4 (1 - d^2), cos of the normals, d the distance from a's
/// plane [thickness].
CLPV_WIDE void add_tap(Row a, Row b, std::size_t count, float share, float inverse_thickness,
                       float* __restrict red, float* __restrict green, float* __restrict blue,
                       float* __restrict sum) {
  CLPV_INDEPENDENT
  for (std::size_t i = 0; i < count; ++i) {
    const float dot = a.nx[i] * b.nx[i] + a.ny[i] * b.ny[i] + a.nz[i] * b.nz[i];
    const float cosine = dot > 0 ? dot : 0, square = cosine * cosine;
    const float off_plane = a.nx[i] * (b.px[i] - a.px[i]) + a.ny[i] * (b.py[i] - a.py[i]) +
                            a.nz[i] * (b.pz[i] - a.pz[i]);
    const float d = off_plane * a.density[i] * inverse_thickness, rest = 1 - d * d;
    const float weight = share * b.computed[i] * square * square * (rest > 0 ? rest : 0);
    red[i] += weight * b.red[i];
    green[i] += weight * b.green[i];
    blue[i] += weight * b.blue[i];
    sum[i] += weight;
  }
}

/// Divides the sums of a row's pixels by their weights.
void normalise(Irradiance& sums, std::size_t first, std::size_t last) {
  for (std::size_t i = first; i < last; ++i) {
    const float scale = sums[3][i] > 0 ? 1 / sums[3][i] : 0;
    for (int c = 0; c < 3; ++c) sums[c][i] *= scale;
    sums[3][i] = sums[3][i] > 0 ? 1.0f : 0.0f;
  }
}

/// Maps a row of the full view to a thinned one: for each pixel, the thinned pixels before and
/// after it.
struct SpreadRow {
  Planes surfaces;
  Irradiance image;

  explicit SpreadRow(std::size_t width) : surfaces(kSurfacePlanes, width), image(width) {}

  /// Neighbour 0 or 1 of `row`; the image's weights are those of linear interpolation.
  void set(const View& thin, const Irradiance& from, std::size_t row, int neighbour) {
    const auto stride = static_cast<int>(thin.stride()), last = static_cast<int>(thin.width()) - 1;
    for (int x = 0; x < static_cast<int>(image.size()); ++x) {
      const float at = static_cast<float>(x - stride / 2) / static_cast<float>(stride),
                  before = std::floor(at);
      const std::size_t i =
          row * thin.width() + std::clamp(static_cast<int>(before) + neighbour, 0, last);
      for (std::size_t plane = 0; plane < kSurfacePlanes; ++plane)
        surfaces[plane][x] = thin.surfaces()[plane][i];
      for (int c = 0; c < 3; ++c) image[c][x] = from[c][i];
      image[3][x] = from[3][i] * (neighbour == 0 ? 1 - (at - before) : at - before);
    }
  }
};

}  // namespace

Irradiance joint_bilateral(const View& view, const Irradiance& image, std::span<const Tap> taps) {
  const auto width = static_cast<int>(view.width()), height = static_cast<int>(view.height());
  Irradiance sums(image.size());
  view.parallel_for(view.height(), 1, [&](pathtracer::PathSampler&, std::size_t row, std::size_t) {
    const int y = static_cast<int>(row);
    for (const Tap& tap : taps) {
      const int first = std::max(0, -tap.x), last = std::min(width, width - tap.x);
      if (y + tap.y < 0 || y + tap.y >= height || first >= last) continue;
      const std::size_t a = row * width + first, b = (row + tap.y) * width + first + tap.x;
      const auto reach = static_cast<float>(std::max({1, std::abs(tap.x), std::abs(tap.y)}));
      add_tap(row_at(view.surfaces(), image, a), row_at(view.surfaces(), image, b),
              static_cast<std::size_t>(last - first), tap.weight, 1 / (kThickness * reach),
              &sums[0][a], &sums[1][a], &sums[2][a], &sums[3][a]);
    }
    normalise(sums, row * width, (row + 1) * width);
  });
  return sums;
}

std::vector<Tap> block_taps() {
  std::vector<Tap> taps;
  for (int y = -1; y <= 2; ++y) {
    for (int x = -1; x <= 2; ++x) taps.push_back({x, y, 1});
  }
  return taps;
}

std::vector<Tap> wavelet_taps(int step) {
  std::vector<Tap> taps;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x)
      taps.push_back({x * step, y * step, (x == 0 ? 2.0f : 1) * (y == 0 ? 2.0f : 1)});
  }
  return taps;
}

Irradiance wavelet_filter(const View& view, const Irradiance& image, int passes) {
  Irradiance result = joint_bilateral(view, image, wavelet_taps(1));
  for (int pass = 1; pass < passes; ++pass)
    result = joint_bilateral(view, result, wavelet_taps(1 << pass));
  return result;
}

Irradiance upsampled(const View& full, const View& thin, const Irradiance& image) {
  const std::size_t width = full.width(), height = full.height(), stride = thin.stride();
  const auto last = static_cast<int>(thin.height()) - 1;
  Irradiance sums(width * height);
  // Bands of rows between the same two thinned rows: the first one starts above the image.
  full.parallel_for(
      thin.height() + 1, 1, [&](pathtracer::PathSampler&, std::size_t band, std::size_t) {
        SpreadRow spread(width);
        const int above = static_cast<int>(band) - 1,
                  start = above * static_cast<int>(stride) + static_cast<int>(stride) / 2;
        const std::size_t first = static_cast<std::size_t>(std::max(0, start)),
                          end = std::min<std::size_t>(
                              height, static_cast<std::size_t>(start + static_cast<int>(stride)));
        for (int i = 0; i < 4 && first < end; ++i) {
          const int row = std::clamp(above + i / 2, 0, last);
          spread.set(thin, image, static_cast<std::size_t>(row), i % 2);
          for (std::size_t y = first; y < end; ++y) {
            const float below =
                static_cast<float>(static_cast<int>(y) - start) / static_cast<float>(stride);
            const std::size_t at = y * width;
            add_tap(row_at(full.surfaces(), sums, at), row_at(spread.surfaces, spread.image, 0),
                    width, i < 2 ? 1 - below : below, 1 / (kThickness * static_cast<float>(stride)),
                    &sums[0][at], &sums[1][at], &sums[2][at], &sums[3][at]);
          }
        }
        for (std::size_t y = first; y < end; ++y) normalise(sums, y * width, (y + 1) * width);
      });
  full.for_each_pixel([&](pathtracer::PathSampler&, std::size_t pixel) {
    const std::size_t x = pixel % width / stride, y = pixel / width / stride;
    if (!sums.computed(pixel)) sums.set(pixel, image.at(y * thin.width() + x));
  });
  return sums;
}

}  // namespace clpv::baselines
