// SPDX-License-Identifier: MIT
// Meshes: primitives of any mode and attribute format, as plain triangles in world space.
#pragma once

#include "scene/gltf_document.hpp"
#include "scene/gltf_material.hpp"
#include "scene/motion.hpp"
#include "scene/notes.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Appends the meshes of all nodes of `motion.tree` to the scene's vertices and triangles, as they are in `posed`: positions
/// in metres, unit normals, texture coordinates as each material maps them. A mirrored node keeps its outside outside; morph
/// targets and skins bend what has them. What moves becomes `motion.meshes` too. Points and lines get a note. Throws
/// Error(bad_input) for bad attributes and for more geometry than the bounds allow.
void append_meshes(const GltfDocument& document, PosedTree& posed, const MaterialSet& materials, Scene& scene,
                   Motion& motion, Notes& notes);

}  // namespace clpv
