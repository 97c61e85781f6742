// SPDX-License-Identifier: MIT
// A scene's textures on the host: decoded to linear light, wrapped, filtered.
#include "reference/texture_lookup.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "scene/mip_chain.hpp"

namespace clpv::reference {
namespace {

/// The linear values of every 8-bit one.
std::array<float, 256> decode_table() {
  std::array<float, 256> table{};
  for (unsigned i = 0; i < table.size(); ++i) table[i] = static_cast<float>(linear_from_srgb(i));
  return table;
}

/// The index inside [0, size) that stands for texel `i`.
std::uint32_t wrap(std::int64_t i, std::uint32_t size, std::uint32_t mode) {
  const std::int64_t n = size;
  if (mode == CLPV_WRAP_CLAMP) return static_cast<std::uint32_t>(std::clamp<std::int64_t>(i, 0, n - 1));
  const std::int64_t period = mode == CLPV_WRAP_MIRROR ? 2 * n : n;
  std::int64_t j = i % period;
  if (j < 0) j += period;
  return static_cast<std::uint32_t>(j < n ? j : period - 1 - j);
}

glm::vec4 texel(const Texture& texture, std::uint32_t x, std::uint32_t y) {
  static const std::array<float, 256> decoded = decode_table();
  const std::uint8_t* rgba = &texture.rgba[4 * (static_cast<std::size_t>(y) * texture.width + x)];
  return {decoded[rgba[0]], decoded[rgba[1]], decoded[rgba[2]], rgba[3] / 255.0f};
}

/// log2 of the root of `square`, by straight lines between the powers of two of `square`; at least 0.
double mip_level(double square) {
  if (!(square < std::numeric_limits<double>::infinity())) return std::numeric_limits<double>::infinity();
  if (square <= 1) return 0;
  const int power = std::ilogb(square);
  return 0.5 * (power + std::ldexp(square, -power) - 1);
}

}  // namespace

glm::vec4 look_up(const Texture& texture, const glm::vec2& uv) {
  // Beyond 2^24 texels a float coordinate no longer tells neighbours apart, and the cast below would
  // overflow.
  constexpr float kLargest = 16777216.0f;
  const glm::vec2 at = uv * glm::vec2(texture.width, texture.height) - 0.5f;
  if (!(std::abs(at.x) < kLargest && std::abs(at.y) < kLargest)) return texel(texture, 0, 0);
  const glm::vec2 base = glm::floor(at), weight = at - base;
  const auto x = static_cast<std::int64_t>(base.x), y = static_cast<std::int64_t>(base.y);
  const std::uint32_t x0 = wrap(x, texture.width, texture.wrap_u),
                      x1 = wrap(x + 1, texture.width, texture.wrap_u);
  const std::uint32_t y0 = wrap(y, texture.height, texture.wrap_v),
                      y1 = wrap(y + 1, texture.height, texture.wrap_v);
  return glm::mix(glm::mix(texel(texture, x0, y0), texel(texture, x1, y0), weight.x),
                  glm::mix(texel(texture, x0, y1), texel(texture, x1, y1), weight.x), weight.y);
}

glm::vec4 look_up(const std::vector<Texture>& levels, const glm::vec2& uv, const glm::dvec2& step_x,
                  const glm::dvec2& step_y) {
  const glm::dvec2 size(levels[0].width, levels[0].height);
  const glm::dvec2 x = step_x * size, y = step_y * size;  // [texels]
  const double coarsest = static_cast<double>(levels.size() - 1);
  const double level = std::min(mip_level(std::max(glm::dot(x, x), glm::dot(y, y))), coarsest);
  const std::size_t fine = level;
  const auto weight = static_cast<float>(level - static_cast<double>(fine));
  const glm::vec4 colour = look_up(levels[fine], uv);
  return weight == 0 ? colour : glm::mix(colour, look_up(levels[fine + 1], uv), weight);
}

}  // namespace clpv::reference
