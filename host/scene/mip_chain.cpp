// SPDX-License-Identifier: MIT
// Box filter for mip levels, in linear light.
#include "scene/mip_chain.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace clpv {
namespace {

const std::array<float, 256>& decode_table() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> values{};
    for (unsigned i = 0; i < 256; ++i) values[i] = static_cast<float>(linear_from_srgb(i));
    return values;
  }();
  return table;
}

/// sRGB encoding by a table that is fine enough for the steepest part of the curve (slope 12.92):
/// the result is the nearest byte or, at a boundary, its neighbour.
std::uint8_t encode(float linear) {
  constexpr std::size_t kSteps = 1 << 14;
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> values(kSteps + 1);
    for (std::size_t i = 0; i <= kSteps; ++i) {
      values[i] = static_cast<std::uint8_t>(srgb_from_linear(static_cast<double>(i) / kSteps));
    }
    return values;
  }();
  return table[static_cast<std::size_t>(std::clamp(linear, 0.0f, 1.0f) * kSteps + 0.5f)];
}

/// Texels of the previous level that a texel covers along one axis, and their weights.
struct Taps {
  std::uint32_t first = 0;
  int count = 0;
  std::array<float, 3> weight{};  // sum 1
};

std::vector<Taps> make_taps(std::uint32_t from, std::uint32_t to) {
  std::vector<Taps> taps(to);
  const double ratio = static_cast<double>(from) / to;
  for (std::uint32_t i = 0; i < to; ++i) {
    const double begin = i * ratio, end = (i + 1) * ratio;
    taps[i].first = static_cast<std::uint32_t>(begin);
    for (std::uint32_t t = taps[i].first; t < from && t < end && taps[i].count < 3; ++t) {
      const double covered = std::min<double>(t + 1, end) - std::max<double>(t, begin);
      taps[i].weight[static_cast<std::size_t>(taps[i].count++)] =
          static_cast<float>(covered / ratio);
    }
  }
  return taps;
}

void filter_texel(const Texture& from, const Taps& x, const Taps& y, bool weigh_by_alpha,
                  std::uint8_t* out) {
  const std::array<float, 256>& linear = decode_table();
  glm::vec3 mean(0), weighted(0);
  float alpha = 0;
  for (int j = 0; j < y.count; ++j) {
    for (int i = 0; i < x.count; ++i) {
      const std::size_t at =
          static_cast<std::size_t>(y.first + static_cast<unsigned>(j)) * from.width + x.first +
          static_cast<unsigned>(i);
      const std::uint8_t* texel = &from.rgba[4 * at];
      const float weight =
          x.weight[static_cast<std::size_t>(i)] * y.weight[static_cast<std::size_t>(j)];
      const glm::vec3 colour(linear[texel[0]], linear[texel[1]], linear[texel[2]]);
      mean += weight * colour;
      weighted += weight * static_cast<float>(texel[3]) * colour;
      alpha += weight * static_cast<float>(texel[3]);
    }
  }
  if (weigh_by_alpha && alpha > 0) mean = weighted / alpha;
  for (int c = 0; c < 3; ++c) out[c] = encode(mean[c]);
  out[3] = static_cast<std::uint8_t>(std::lround(std::min(alpha, 255.0f)));
}

/// The next mip level.
Texture halved(const Texture& from, bool weigh_by_alpha) {
  Texture to;
  to.width = std::max(1u, from.width / 2);
  to.height = std::max(1u, from.height / 2);
  to.wrap_u = from.wrap_u;
  to.wrap_v = from.wrap_v;
  to.rgba.resize(static_cast<std::size_t>(to.width) * to.height * 4);
  const std::vector<Taps> columns = make_taps(from.width, to.width),
                          rows = make_taps(from.height, to.height);
  std::uint8_t* out = to.rgba.data();
  for (const Taps& row : rows) {
    for (const Taps& column : columns) {
      filter_texel(from, column, row, weigh_by_alpha, out);
      out += 4;
    }
  }
  return to;
}

}  // namespace

double linear_from_srgb(unsigned byte) {
  const double encoded = byte / 255.0;
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

unsigned srgb_from_linear(double linear) {
  const double encoded =
      linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<unsigned>(std::lround(255 * std::clamp(encoded, 0.0, 1.0)));
}

std::vector<Texture> mip_chain(const Texture& texture, bool weigh_by_alpha) {
  std::vector<Texture> levels{texture};
  while (levels.back().width > 1 || levels.back().height > 1)
    levels.push_back(halved(levels.back(), weigh_by_alpha));
  return levels;
}

std::vector<bool> textures_with_holes(const SceneData& scene) {
  std::vector<bool> holes(scene.textures.size(), false);
  for (const ClpvMaterial& m : scene.materials) {
    if ((m.flags & CLPV_MATERIAL_MASKED) != 0 && m.texture != CLPV_NO_TEXTURE)
      holes[m.texture] = true;
  }
  return holes;
}

}  // namespace clpv
