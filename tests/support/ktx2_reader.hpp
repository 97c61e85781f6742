// SPDX-License-Identifier: MIT
// Reader of KTX 2.0 files of 3-D textures of halves, from the specification: every field is
// checked. Shares nothing with host/bake/ktx2.cpp. Look-ups as the engines' shaders do them.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
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
  const auto at = [&file](std::size_t offset, auto value) {
    if (offset + sizeof value > file.size()) {
      ADD_FAILURE() << "the file ends before byte " << offset;
      return value;
    }
    std::memcpy(&value, file.data() + offset, sizeof value);
    return value;
  };
  const auto u32 = [&](std::size_t offset) { return at(offset, std::uint32_t{0}); };
  const auto u64 = [&](std::size_t offset) { return at(offset, std::uint64_t{0}); };
  EXPECT_EQ(file.substr(0, 12), std::string("\xABKTX 20\xBB\r\n\x1A\n"));
  EXPECT_EQ(u32(12), 97u) << "VK_FORMAT_R16G16B16A16_SFLOAT";
  EXPECT_EQ(u32(16), 2u) << "typeSize";
  ReadTexture texture;
  texture.size = {u32(20), u32(24), u32(28)};
  EXPECT_EQ(u32(32), 0u) << "layerCount of no array";
  EXPECT_EQ(u32(36), 1u) << "faceCount";
  EXPECT_EQ(u32(40), 1u) << "levelCount";
  EXPECT_EQ(u32(44), 0u) << "supercompressionScheme";
  const std::uint32_t dfd = u32(48), dfd_size = u32(52), kvd = u32(56), kvd_size = u32(60);
  EXPECT_EQ(u64(64) + u64(72), 0u) << "no supercompression global data";
  const std::uint64_t level = u64(80), bytes = u64(88);
  EXPECT_EQ(u64(96), bytes) << "uncompressedByteLength";
  EXPECT_EQ(dfd, 104u) << "after the level index";
  EXPECT_EQ(u32(dfd), dfd_size);
  EXPECT_EQ(u32(dfd + 4), 0u) << "Khronos, basic format";
  EXPECT_EQ(u32(dfd + 8), 2u | (dfd_size - 4) << 16) << "version and size of the block";
  EXPECT_EQ(u32(dfd + 12), 0x00010101u) << "RGBSDA, BT.709, linear, straight alpha";
  EXPECT_EQ(u32(dfd + 16), 0u) << "texel block";
  EXPECT_EQ(u32(dfd + 20), 8u) << "bytesPlane0";
  EXPECT_EQ(u32(dfd + 24), 0u);
  EXPECT_EQ(dfd_size, 4 + 24 + 4 * 16u);
  const std::uint32_t channels[] = {0, 1, 2, 15};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t sample = dfd + 28 + 16 * i;
    EXPECT_EQ(u32(sample), 16 * i | 15u << 16 | (channels[i] | 0xC0u) << 24) << "channel " << i;
    EXPECT_EQ(u32(sample + 4), 0u);
    EXPECT_EQ(at(sample + 8, 0.0f), -1);
    EXPECT_EQ(at(sample + 12, 0.0f), 1);
  }
  EXPECT_EQ(kvd, dfd + dfd_size);
  EXPECT_EQ(file.substr(kvd + 4, 10), std::string("KTXwriter\0", 10));
  EXPECT_EQ(kvd_size, 4 + (u32(kvd) + 3) / 4 * 4);
  EXPECT_GE(level, kvd + kvd_size);
  EXPECT_EQ(level % 8, 0u) << "aligned to texels";
  const std::size_t count =
      static_cast<std::size_t>(texture.size.x) * texture.size.y * texture.size.z;
  EXPECT_EQ(bytes, 8 * count);
  EXPECT_EQ(level + bytes, file.size());
  for (std::size_t i = 0; i < count; ++i) {
    glm::vec4 texel;
    for (int c = 0; c < 4; ++c)
      texel[c] =
          number_of_half(at(level + 8 * i + 2 * static_cast<std::size_t>(c), std::uint16_t{0}));
    texture.texels.push_back(texel);
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
