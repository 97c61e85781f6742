// SPDX-License-Identifier: MIT
// The node hierarchy, flattened: where each mesh, camera and light stands.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/gltf_document.hpp"

namespace clpv {

struct GltfNode {
  int index;  ///< in the document
  glm::dmat4 to_world;
};

/// The nodes of the default scene (else the first; without scenes, all root nodes), parents first, each with
/// its transform to world space. `root` is applied last. Throws Error(bad_input) for cycles, several parents,
/// excessive depth and transforms that are not finite.
std::vector<GltfNode> flatten_nodes(const GltfDocument& document, const glm::dmat4& root);

}  // namespace clpv
