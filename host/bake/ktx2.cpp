// SPDX-License-Identifier: MIT
#include "bake/ktx2.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>

#include "support/array_files.hpp"
#include "support/error.hpp"

namespace clpv::bake {
namespace {

constexpr std::uint32_t kFormatRgbaHalf = 97;  // VK_FORMAT_R16G16B16A16_SFLOAT
constexpr int kShVolumes = 7;

/// Data format descriptor of four signed linear halves (Khronos Data Format 1.3, basic block).
std::string descriptor() {
  constexpr std::uint8_t kModelRgbsda = 1, kBt709 = 1, kLinear = 1, kFloatSigned = 0xC0, kNone = 0;
  constexpr std::uint16_t kVersion = 2, kSize = 24 + 4 * 16;
  std::string block;
  append_little(block, 4u + kSize, 0u);  // total size; vendor, type
  append_little(block, kVersion, kSize, kModelRgbsda, kBt709, kLinear, kNone);
  append_little(block, 0u, 8u, 0u);                    // texel block of 1 x 1 x 1; bytes of plane 0
  constexpr std::uint8_t kChannels[] = {0, 1, 2, 15};  // red, green, blue, alpha
  for (std::uint16_t i = 0; i < 4; ++i) {
    append_little(block, static_cast<std::uint16_t>(16 * i), std::uint8_t{15},
                  static_cast<std::uint8_t>(kChannels[i] | kFloatSigned), 0u, -1.0f, 1.0f);
  }
  return block;
}

Texture3d cubes(const ProbeFormat& format, const BakedProbes& baked, double factor) {
  const ProbeGrid& grid = baked.grid;
  Texture3d texture{texture_size(format, grid), {}};
  const glm::uvec3 count(grid.count);
  texture.texels.resize(6 * grid.size());
  for (std::size_t probe = 0; probe < grid.size(); ++probe) {
    const glm::uvec3 at(grid.at(probe));
    for (unsigned face = 0; face < 6; ++face) {
      const std::size_t y = at.y + face % 2 * count.y, z = at.z + face / 2 * count.z;
      texture.texels[(z * texture.size.y + y) * texture.size.x + at.x] =
          glm::vec4(factor * glm::dvec3(baked.coefficients[6 * probe + face]), baked.valid[probe]);
    }
  }
  return texture;
}

Texture3d harmonics_atlas(const ProbeFormat& format, const BakedProbes& baked, double factor) {
  const ProbeGrid& grid = baked.grid;
  Texture3d texture{texture_size(format, grid), {}};
  const int depth = grid.count.z + 2;
  texture.texels.reserve(std::size_t{texture.size.x} * texture.size.y * texture.size.z);
  for (int z = 0; z < kShVolumes * depth; ++z) {
    const int slice = std::clamp(z % depth - 1, 0, grid.count.z - 1);
    for (int y = 0; y < grid.count.y; ++y) {
      for (int x = 0; x < grid.count.x; ++x) {
        const std::size_t probe = grid.index({x, y, slice});
        glm::vec4 texel(baked.filled || baked.valid[probe] ? 1.0f : 0.0f);
        for (int i = 0; i < 4; ++i) {
          const int number = 4 * (z / depth) + i;
          if (number < 27)
            texel[i] = static_cast<float>(
                factor *
                baked.coefficients[9 * probe + static_cast<std::size_t>(number / 3)][number % 3]);
        }
        texture.texels.push_back(texel);
      }
    }
  }
  return texture;
}

}  // namespace

std::uint16_t half_of(float value) {
  return std::bit_cast<std::uint16_t>(Eigen::half(value));
}

glm::uvec3 texture_size(const ProbeFormat& format, const ProbeGrid& grid) {
  const glm::uvec3 count(grid.count);
  glm::uvec3 size;
  if (format.name == "ambient-cube" || format.name == "ambient-cube-mean") {
    size = {count.x, 2 * count.y, 3 * count.z};
  } else if (format.name == "sh3" || format.name == "sh3-windowed") {
    for (int axis = 0; axis < 3; ++axis) {
      if (grid.count[axis] < 2)
        throw Error(ExitCode::usage,
                    "probes: found {} along {}, allowed for a .ktx2 of {}: 2 or more",
                    grid.count[axis], "xyz"[axis], format.name);
    }
    size = {count.x, count.y, kShVolumes * (count.z + 2)};
  } else {
    throw Error(ExitCode::usage,
                "format: found '{}' for a .ktx2, allowed: ambient-cube, ambient-cube-mean, sh3, "
                "sh3-windowed, or a .npz",
                format.name);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] > kMaxTextureSide)
      throw Error(ExitCode::usage,
                  "probes: found {} along {}, a texture of {} x {} x {}; allowed: sides up to {}",
                  grid.count[axis], "xyz"[axis], size.x, size.y, size.z, kMaxTextureSide);
  }
  return size;
}

double intensity_of(const BakedProbes& baked) {
  float most = 0;
  for (const glm::vec3& c : baked.coefficients)
    most = std::max({most, std::abs(c.x), std::abs(c.y), std::abs(c.z)});
  if (most == 0 || (most >= 0x1p-6f && most < 0x1p15f)) return 1;
  int exponent = 0;
  std::frexp(most, &exponent);
  return std::ldexp(1.0, exponent - 15);
}

Texture3d texture_of(const ProbeFormat& format, const BakedProbes& baked, double intensity) {
  const double factor = 1 / intensity;  // a float of it is infinite for the dimmest light
  return format.size == 6 ? cubes(format, baked, factor) : harmonics_atlas(format, baked, factor);
}

std::string ktx2_bytes(const Texture3d& texture, const std::string& writer) {
  constexpr std::size_t kHeader = 80, kLevelIndex = 24, kTexel = 8;
  constexpr std::uint16_t kInfinite = 0x7c00;  // exponent of a half that is infinite or NaN
  const std::string description = descriptor();
  const std::string pair = std::string("KTXwriter") + '\0' + writer + '\0';
  const std::size_t pair_size = 4 + (pair.size() + 3) / 4 * 4, first = kHeader + kLevelIndex,
                    pairs_at = first + description.size(),
                    texels_at = (pairs_at + pair_size + kTexel - 1) / kTexel * kTexel,
                    size = texture.texels.size() * kTexel;
  std::string file("\xABKTX 20\xBB\r\n\x1A\n");
  const auto add = [&file](auto... values) {
    append_little(file, static_cast<std::uint32_t>(values)...);
  };
  add(kFormatRgbaHalf, 2);  // bytes of a number
  add(texture.size.x, texture.size.y, texture.size.z);
  add(0, 1, 1, 0);  // layers, faces, levels, supercompression
  add(first, description.size(), pairs_at, pair_size);
  append_little(file, std::uint64_t{0}, std::uint64_t{0}, std::uint64_t{texels_at},
                std::uint64_t{size}, std::uint64_t{size});
  file += description;
  add(pair.size());
  file += pair;
  file.resize(texels_at, '\0');
  for (const glm::vec4& texel : texture.texels) {
    for (int channel = 0; channel < 4; ++channel) {
      const std::uint16_t half = half_of(texel[channel]);
      if ((half & kInfinite) == kInfinite)
        throw Error(ExitCode::run_time, ".ktx2: found {}, allowed: below 65520", texel[channel]);
      append_little(file, half);
    }
  }
  return file;
}

}  // namespace clpv::bake
