// SPDX-License-Identifier: MIT
// Bounds of scenes. Scenes are untrusted: every bound is checked before memory of that size is
// allocated.
#pragma once

#include <cstddef>
#include <cstdint>

#include "support/json_schema.hpp"

namespace clpv::bounds {

// Bytes of all buffers of a model, of one image file, and of a .glb file, which has both and JSON.
inline constexpr std::uint64_t kBufferBytes = 2ull << 30;
inline constexpr std::uint64_t kImageFileBytes = 256ull << 20;
inline constexpr std::uint64_t kGlbBytes = kBufferBytes + kJsonBytes;

// Decoded images. Common devices support textures of up to 16384 x 16384; 1 GiB is 64 textures of
// 2048 x 2048.
inline constexpr std::uint32_t kImageSide = 16384;
inline constexpr std::uint64_t kTexelBytes = 1ull << 30;
inline constexpr std::size_t kTextures = 4096;

// Map of a sky, 12 bytes per texel, and its radiance [W/m^2/sr]. The sun has a radiance of 2e7 and
// a luminance of 1.6e9.
inline constexpr int kSkyWidth = 8192, kSkyHeight = 4096, kSkyChannels = 16;
inline constexpr double kSkyRadiance = 1e10;

// Radiance of emissive materials [W/m^2/sr].
inline constexpr double kEmission = 1e9;

// Coefficients of a medium [1/m], and its anisotropy.
inline constexpr double kExtinction = 1e6;
inline constexpr double kAnisotropy = 0.9;

// Entries of a JSON array (nodes, meshes, accessors, ...), materials (about 3 kB each in tinygltf),
// and depth of the node tree.
inline constexpr std::size_t kListEntries = 1u << 18;
inline constexpr std::size_t kMaterials = 1u << 14;
inline constexpr int kNodeDepth = 1024;

// Geometry after instancing: 768 MiB of vertices (48 bytes each), 256 MiB of triangles (16 bytes
// each). Instances of EXT_mesh_gpu_instancing. Replaced elements of all sparse accessors, several
// of which may share a view.
inline constexpr std::uint64_t kVertices = 16ull << 20;
inline constexpr std::uint64_t kTriangles = 16ull << 20;
inline constexpr std::size_t kInstances = 1u << 18;  // 144 bytes each
inline constexpr std::uint64_t kSparseElements = 64ull << 20;

// Animation: times and values of all curves of a model (8 bytes each), keys of one camera or light
// in a scene file, and times [s].
inline constexpr std::uint64_t kKeyNumbers = 16ull << 20;
inline constexpr std::uint64_t kMorphNumbers = 64ull << 20;  // in all morph targets, 4 bytes each
inline constexpr std::size_t kJoints = 1u << 16;             // in all skins
inline constexpr std::size_t kSceneKeys = 1u << 16;
inline constexpr double kSeconds = 1e6;

// Every light has RSMs and a shadow map.
inline constexpr std::size_t kLights = 64;
inline constexpr double kLightScale = 1e6;  // factor of all intensities, or 1 / factor
inline constexpr std::size_t kCameras = 1024;

// Coordinates [m]. At 1e7 m the resolution of a float is 1 m.
inline constexpr double kCoordinate = 1e7;
inline constexpr double kMinLength = 1e-6;  // least size of directions, distances and angles

// Vertical field of view of a camera [degrees].
inline constexpr double kMinFov = 0.01, kMaxFov = 179.9;

// Extent below which a scene is noted as small [m]: ten times the near plane of a lamp's views.
inline constexpr double kSmallScene = 0.1;

// Notes to the user that are stored; further ones are counted.
inline constexpr std::size_t kNotes = 32;

}  // namespace clpv::bounds
