// SPDX-License-Identifier: MIT
// What bends a primitive: the joints its vertices go with, and its morph targets. Internal to the loader.
#pragma once

#include "scene/gltf_document.hpp"
#include "scene/gltf_primitive.hpp"
#include "scene/notes.hpp"

namespace clpv {

/// Reads JOINTS_0, WEIGHTS_0 and the targets' POSITION and NORMAL for the vertices that `primitive` has, in their order.
/// `numbers` counts what all targets hold so far. Throws Error(bad_input) for attributes of another kind or number, weights
/// that are no shares, numbers that are not finite, and more than the bounds allow.
void read_deformation(const GltfDocument& document, const tinygltf::Primitive& source,
                      LocalPrimitive& primitive, std::uint64_t& numbers, Notes& notes);

}  // namespace clpv
