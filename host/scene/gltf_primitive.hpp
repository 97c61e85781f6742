// SPDX-License-Identifier: MIT
// One mesh primitive in its own space: triangles over just the vertices they use. Internal to the loader.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/gltf_document.hpp"
#include "scene/gltf_material.hpp"
#include "scene/motion.hpp"
#include "scene/notes.hpp"

namespace clpv {

/// How much more the scene may hold.
struct Room {
  std::uint64_t vertices, triangles;
  std::uint64_t morph_numbers;  ///< of morph targets
};

/// Reads primitive `index` of mesh `mesh`, with the joints its vertices go with and its morph targets, which take up
/// `room.morph_numbers`. No triangles, and a note, where it is made of points or lines. `slots` is scratch memory, all
/// kNoSlot between calls: primitives often share one huge accessor and use a small part of it. Throws Error(bad_input).
LocalPrimitive read_primitive(const GltfDocument& document, int mesh, std::size_t index,
                              const MaterialSet& materials, Room& room, std::vector<std::uint32_t>& slots,
                              Notes& notes);

inline constexpr std::uint32_t kNoSlot = 0xffffffff;

}  // namespace clpv
