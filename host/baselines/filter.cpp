// SPDX-License-Identifier: MIT
#include "baselines/filter.hpp"

#include <cmath>
#include <cstdlib>

namespace clpv::baselines {
namespace {

// Tuned on Sponza, the atrium and the Cornell box with two paths per pixel.
constexpr int kSharpness = 2;    // normals count with their cosine to the power 2^2
constexpr float kThickness = 2;  // planes differ by up to so many pixels' edges per pixel of distance

/// Weight of `other` at a distance of `reach` pixels, from 0 to 1.
float similarity(const PixelSurface& surface, const PixelSurface& other, float reach) {
  float normals = std::max(0.0f, glm::dot(surface.normal, other.normal));
  for (int i = 0; i < kSharpness; ++i) normals *= normals;
  const float off_plane = glm::dot(surface.normal, other.position - surface.position);
  const float relative = off_plane / (kThickness * reach * surface.edge);
  return normals * std::max(0.0f, 1 - relative * relative);
}

}  // namespace

std::vector<Tap> block_taps(unsigned step) {
  const int s = static_cast<int>(step);
  std::vector<Tap> taps;
  for (int y = -1; y <= 2; ++y) {
    for (int x = -1; x <= 2; ++x) taps.push_back({x * s, y * s, 1});
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

Irradiance joint_bilateral(const View& view, const Irradiance& image, std::span<const Tap> taps) {
  const auto width = static_cast<int>(view.view().width), height = static_cast<int>(view.view().height);
  const std::vector<PixelSurface>& surfaces = view.surfaces();
  Irradiance filtered(image.size(), glm::vec4(0));
  view.for_each_pixel(1, [&](reference::PathSampler&, std::size_t pixel) {
    const int px = static_cast<int>(pixel) % width, py = static_cast<int>(pixel) / width;
    glm::vec4 sum(0);
    for (const Tap& tap : taps) {
      const int x = px + tap.x, y = py + tap.y;
      if (x < 0 || x >= width || y < 0 || y >= height) continue;
      const std::size_t other = static_cast<std::size_t>(y) * width + x;
      if (image[other].w == 0) continue;
      const auto reach = static_cast<float>(std::max({1, std::abs(tap.x), std::abs(tap.y)}));
      const float weight = tap.weight * similarity(surfaces[pixel], surfaces[other], reach);
      sum += weight * glm::vec4(glm::vec3(image[other]), 1);
    }
    if (sum.w > 0) filtered[pixel] = glm::vec4(glm::vec3(sum) / sum.w, 1);
  });
  return filtered;
}

Irradiance wavelet_filter(const View& view, Irradiance image, int passes) {
  for (int pass = 0; pass < passes; ++pass) image = joint_bilateral(view, image, wavelet_taps(1 << pass));
  return image;
}

Irradiance replicated(const View& view, const Irradiance& image, unsigned stride) {
  const unsigned width = view.view().width, height = view.view().height;
  Irradiance all(image.size());
  for (unsigned y = 0; y < height; ++y) {
    for (unsigned x = 0; x < width; ++x) {
      const unsigned from_x = View::sample_of(x, stride, width), from_y = View::sample_of(y, stride, height);
      all[std::size_t{y} * width + x] = image[std::size_t{from_y} * width + from_x];
    }
  }
  return all;
}

}  // namespace clpv::baselines
