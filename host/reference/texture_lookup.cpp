// A scene's textures on the host: decoded to linear light, wrapped, filtered.
#include "reference/texture_lookup.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace clpv::reference {
namespace {

/// sRGB's decoding of every 8-bit value (IEC 61966-2-1).
std::array<float, 256> decode_table() {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    const double encoded = static_cast<double>(i) / 255.0;
    table[i] =
        static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
  }
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

}  // namespace clpv::reference
