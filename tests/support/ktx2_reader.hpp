// SPDX-License-Identifier: MIT
// Reader of KTX 2.0 files of 3-D textures of halves, from the specification: every field is
// checked. Shares nothing with host/bake/ktx2.cpp. Look-ups as the engines' shaders do them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <glm/glm.hpp>
#include <numbers>
#include <string>
#include <vector>

namespace clpv::test {

/// By IEEE 754: sign, exponent of 5 bits, fraction of 10.
inline float number_of_half(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const double size = exponent == 0    ? std::ldexp(fraction, -24)
                      : exponent == 31 ? (fraction == 0 ? INFINITY : NAN)
                                       : std::ldexp(1024 + fraction, exponent - 25);
  return static_cast<float>(bits >> 15 ? -size : size);
}

struct ReadTexture {
  glm::ivec3 size{0};
  std::vector<glm::vec4> texels;

  glm::dvec4 texel(glm::ivec3 at) const {
    at = glm::clamp(at, glm::ivec3(0), size - 1);
    return glm::dvec4(texels[(static_cast<std::size_t>(at.z) * size.y + at.y) * size.x + at.x]);
  }

  /// Linear filter, clamped to the edges: coordinates in [0, 1].
  glm::dvec4 sample(const glm::dvec3& uvw) const {
    const glm::dvec3 at = uvw * glm::dvec3(size) - 0.5, low = glm::floor(at), part = at - low;
    glm::dvec4 sum(0);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 off(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 share = glm::mix(1.0 - part, part, glm::dvec3(off));
      sum += share.x * share.y * share.z * texel(glm::ivec3(low) + off);
    }
    return sum;
  }
};

inline ReadTexture read_ktx2(const std::string& file) {
  constexpr std::size_t kKeys = 196;  // offset of the key/value data
  if (file.size() < kKeys + 4) {
    ADD_FAILURE() << "the file ends at byte " << file.size();
    return {};
  }
  const auto u32 = [&file](std::size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, &file[offset], sizeof value);
    return value;
  };
  ReadTexture texture{{u32(20), u32(24), u32(28)}, {}};
  const std::size_t count =
      static_cast<std::size_t>(texture.size.x) * texture.size.y * texture.size.z;
  const std::uint32_t keys = (4 + u32(kKeys) + 3) / 4 * 4, level = u32(80),
                      bytes = static_cast<std::uint32_t>(8 * count);
  EXPECT_EQ(file.substr(0, 12), std::string("\xABKTX 20\xBB\r\n\x1A\n"));
  // VK_FORMAT_R16G16B16A16_SFLOAT, typeSize; width, height, depth; no array, one face, one level,
  // no supercompression; places and sizes of the format and of the keys; no global data; the
  // level's place, bytes and uncompressed bytes. The format: Khronos, basic, version 2 and size of
  // the block; RGBSDA, BT.709, linear, straight alpha; bytesPlane0.
  std::vector<std::uint32_t> words{
      97, 2, u32(20), u32(24), u32(28), 0, 1,     1, 0,  104, 92,           kKeys,      keys, 0, 0,
      0,  0, level,   0,       bytes,   0, bytes, 0, 92, 0,   2 | 88 << 16, 0x00010101, 0,    8, 0};
  const std::uint32_t channels[] = {0, 1, 2, 15};
  for (std::uint32_t i = 0; i < 4; ++i)  // signed floats of 16 bits, from -1 to 1
    words.insert(words.end(),
                 {16 * i | 15u << 16 | (channels[i] | 0xC0u) << 24, 0,
                  std::bit_cast<std::uint32_t>(-1.0f), std::bit_cast<std::uint32_t>(1.0f)});
  for (std::size_t i = 0; i < words.size(); ++i)
    EXPECT_EQ(u32(12 + 4 * i), words[i]) << "byte " << 12 + 4 * i;
  EXPECT_EQ(12 + 4 * words.size(), kKeys);
  EXPECT_EQ(file.substr(kKeys + 4, 10), std::string("KTXwriter\0", 10));
  EXPECT_GE(level, kKeys + keys);
  EXPECT_EQ(level % 8, 0u) << "aligned to texels";
  EXPECT_EQ(level + bytes, file.size());
  for (std::size_t i = 0; i < count && level + bytes == file.size(); ++i) {
    std::uint16_t halves[4];
    std::memcpy(halves, &file[level + 8 * i], sizeof halves);
    glm::vec4& texel = texture.texels.emplace_back();
    for (int c = 0; c < 4; ++c) texel[c] = number_of_half(halves[c]);
  }
  return texture;
}

/// Radiance that leaves a white surface, as Bevy's irradiance_volume.wgsl has it. `translation` and
/// `scale` of the entity, a cube of edge 1.
inline glm::dvec3 bevy_light(const ReadTexture& volume, const glm::dvec3& translation,
                             const glm::dvec3& scale, const glm::dvec3& position,
                             const glm::dvec3& normal) {
  const glm::dvec3 atlas(volume.size), resolution = atlas / glm::dvec3(1, 2, 3);
  const glm::dvec3 unit = (position - translation) / scale;
  const glm::dvec3 stp = glm::clamp((unit + 0.5) * resolution, glm::dvec3(0.5), resolution - 0.5);
  glm::dvec3 sum(0);
  for (int axis = 0; axis < 3; ++axis) {
    const glm::dvec3 shift(0, normal[axis] < 0 ? 0.5 : 0, axis / 3.0);
    sum += glm::dvec3(volume.sample(stp / atlas + shift)) * normal[axis] * normal[axis];
  }
  return sum;
}

/// Irradiance as three.js's lightprobes_pars_fragment has it: probes from `lower` to `upper`.
inline glm::dvec3 three_light(const ReadTexture& atlas, const glm::dvec3& lower,
                              const glm::dvec3& upper, const glm::dvec3& position,
                              const glm::dvec3& n) {
  const double slices = atlas.size.z / 7.0;
  const glm::dvec3 count(atlas.size.x, atlas.size.y, slices - 2), range = upper - lower;
  const glm::dvec3 at = position + n * range / (count - 1.0) * 0.5;
  glm::dvec3 uvw = glm::clamp((at - lower) / range, 0.0, 1.0);
  uvw = uvw * (count - 1.0) / count + 0.5 / count;
  double s[28];
  for (int volume = 0; volume < 7; ++volume) {
    const double w = (uvw.z * count.z + 1 + volume * slices) / (7 * slices);
    const glm::dvec4 texel = atlas.sample({uvw.x, uvw.y, w});
    for (int i = 0; i < 4; ++i) s[4 * volume + i] = texel[i];
  }
  const auto c = [&s](int i) { return glm::dvec3(s[3 * i], s[3 * i + 1], s[3 * i + 2]); };
  const glm::dvec3 e = c(0) * 0.886227 + 2 * 0.511664 * (c(1) * n.y + c(2) * n.z + c(3) * n.x) +
                       2 * 0.429043 * (c(4) * n.x * n.y + c(5) * n.y * n.z + c(7) * n.x * n.z) +
                       c(6) * (0.743125 * n.z * n.z - 0.247708) +
                       c(8) * 0.429043 * (n.x * n.x - n.y * n.y);
  return glm::max(e, 0.0);
}

}  // namespace clpv::test
