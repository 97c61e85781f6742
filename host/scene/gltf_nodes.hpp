// SPDX-License-Identifier: MIT
// The node hierarchy of a glTF document, as a tree of nodes that may move.
#pragma once

#include <map>

#include "scene/gltf_document.hpp"
#include "scene/node_tree.hpp"

namespace clpv {

/// The nodes of the default scene (else the first; without scenes, all root nodes), parents first; those of `curves` (by
/// index in the document) move. `root` is applied last. Throws Error(bad_input) for cycles, several parents and excessive
/// depth.
NodeTree read_nodes(const GltfDocument& document, const std::map<int, NodeCurves>& curves,
                    const glm::dmat4& root);

}  // namespace clpv
