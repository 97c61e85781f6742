// SPDX-License-Identifier: MIT
// Meshes: primitives of any mode and attribute format, as plain triangles in world space.
#pragma once

#include <vector>

#include "scene/gltf_document.hpp"
#include "scene/gltf_material.hpp"
#include "scene/gltf_nodes.hpp"
#include "scene/notes.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Appends the meshes of all nodes to the scene's vertices and triangles: positions in metres, unit normals,
/// texture coordinates as each material maps them. A mirrored node keeps its outside outside. Points and
/// lines get a note. Throws Error(bad_input) for bad attributes and for more geometry than the bounds allow.
void append_meshes(const GltfDocument& document, const std::vector<GltfNode>& nodes,
                   const MaterialSet& materials, Scene& scene, Notes& notes);

}  // namespace clpv
