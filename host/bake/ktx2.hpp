// SPDX-License-Identifier: MIT
// KTX 2.0 files of 3-D textures of halves (Khronos, 'KTX File Format Specification', version 2.0),
// and the layouts of engines in them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "bake/bake.hpp"

namespace clpv::bake {

/// The half nearest to a number; infinite from 65,520 on.
std::uint16_t half_of(float value);

/// A 3-D texture of RGBA, x fastest.
struct Texture3d {
  glm::uvec3 size{0};
  std::vector<glm::vec4> texels;
};

inline constexpr unsigned kMaxTextureSide = 2048;  ///< that all devices of WebGPU and WebGL 2 have

/// Size of the texture of a grid: of ambient cubes (Bevy), (NX, 2 NY, 3 NZ); of sh3 (three.js),
/// (NX, NY, 7 (NZ + 2)). Throws Error(usage) for sides above kMaxTextureSide, for another format,
/// and for sh3 with one probe along an axis.
glm::uvec3 texture_size(const ProbeFormat& format, const ProbeGrid& grid);

/// Power of two by which a file's numbers are multiplied: 1 if the largest of all is 0 or from 2^-6
/// to 2^15, else so that it is below 2^15 and at least 2^14.
double intensity_of(const BakedProbes& baked);

/// Bevy's irradiance volume: values of the faces x, y, z along z; of negative faces NY further
/// along y; alpha: validity. Or three.js's LightProbeGrid: seven volumes along z with 27 numbers in
/// the order c0.rgb c1.r | c1.gb c2.rg ..., each between copies of its first and last slice; the
/// 28th number: 1 where a probe has light. Light is divided by `intensity`.
Texture3d texture_of(const ProbeFormat& format, const BakedProbes& baked, double intensity);

/// The file: one level without compression. `writer`: of its metadata.
std::string ktx2_bytes(const Texture3d& texture, const std::string& writer);

}  // namespace clpv::bake
