// SPDX-License-Identifier: MIT
// A glTF document's animations, as the curves that its nodes follow.
#pragma once

#include <map>

#include "scene/gltf_document.hpp"
#include "scene/node_tree.hpp"
#include "scene/notes.hpp"

namespace clpv {

/// The curves of each node that moves, by its index. All animations play, at once and from their own times; where several
/// move the same of a node, the first does, and a note says so. Throws Error(bad_input) for samplers whose accessors are of
/// another kind, or do not belong together; for times that are not finite, below 0, or do not rise; for rotations that are
/// none; and for more numbers than the bounds allow, before any is read.
std::map<int, NodeCurves> read_animations(const GltfDocument& document, Notes& notes);

}  // namespace clpv
