// SPDX-License-Identifier: MIT
// How much a scene may ask for. Scenes are untrusted: each bound is checked before anything of that size is
// allocated.
#pragma once

#include <cstddef>
#include <cstdint>

#include "support/json_schema.hpp"

namespace clpv::bounds {

// Bytes. All buffers of a model together, and one image file; a .glb holds both kinds and the JSON.
inline constexpr std::uint64_t kBufferBytes = 2ull << 30;
inline constexpr std::uint64_t kImageFileBytes = 256ull << 20;
inline constexpr std::uint64_t kGlbBytes = kBufferBytes + kJsonBytes;

// Decoded images. 16384 is the largest texture side common devices take; 1 GiB of texels is 64 of 2048 x
// 2048.
inline constexpr std::uint32_t kImageSide = 16384;
inline constexpr std::uint64_t kTexelBytes = 1ull << 30;
inline constexpr std::size_t kTextures = 4096;

// A sky's map, 12 bytes a texel, and its radiance [W/m^2/sr]: the sun's own is 2e7 as radiance, 1.6e9 as luminance.
inline constexpr int kSkyWidth = 8192, kSkyHeight = 4096, kSkyChannels = 16;
inline constexpr double kSkyRadiance = 1e10;

// Entries of any one array of the JSON (nodes, meshes, accessors, ...), materials, and depth of the node tree. A
// material takes tinygltf some 3 kB.
inline constexpr std::size_t kListEntries = 1u << 18;
inline constexpr std::size_t kMaterials = 1u << 14;
inline constexpr int kNodeDepth = 1024;

// Geometry after instancing: 16 Mi vertices of 48 bytes are 768 MiB, 16 Mi triangles of 16 bytes are 256 MiB.
// And all replaced elements of sparse accessors, several of which may share one view.
inline constexpr std::uint64_t kVertices = 16ull << 20;
inline constexpr std::uint64_t kTriangles = 16ull << 20;
inline constexpr std::uint64_t kSparseElements = 64ull << 20;

// Animation: times and values of all curves of a model, 8 bytes each, and keys of one thing in a scene file. Times [s]: a
// day is 1e5.
inline constexpr std::uint64_t kKeyNumbers = 16ull << 20;
inline constexpr std::uint64_t kMorphNumbers = 64ull << 20;  // of morph targets, 4 bytes each
inline constexpr std::size_t kJoints = 1u << 16;             // of all skins
inline constexpr std::size_t kSceneKeys = 1u << 16;
inline constexpr double kSeconds = 1e6;

// Each light costs its own RSMs and shadow map.
inline constexpr std::size_t kLights = 64;
inline constexpr std::size_t kCameras = 1024;

// Coordinates [m]: at 1e7 a float resolves 1 m, far too little to light anything.
inline constexpr double kCoordinate = 1e7;

// Notes to the user kept word for word; the rest are counted.
inline constexpr std::size_t kNotes = 32;

}  // namespace clpv::bounds
