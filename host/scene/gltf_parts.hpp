// SPDX-License-Identifier: MIT
// The parts of a glTF document, each as a scene has it. Internal to the loader.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "scene/gltf_document.hpp"
#include "scene/gltf_material.hpp"
#include "scene/motion.hpp"
#include "scene/notes.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// The curves of each node that moves, by its index. All animations play, at once and from their own times; where several
/// move the same of a node, the first does, and a note says so. Throws Error(bad_input) for samplers whose accessors are of
/// another kind, or do not belong together; for times that are not finite, below 0, or do not rise; for rotations that are
/// none; and for more numbers than the bounds allow, before any is read.
std::map<int, NodeCurves> read_animations(const GltfDocument& document, Notes& notes);

/// The nodes of the default scene (else the first; without scenes, all root nodes), parents first; those of `curves` (by
/// index in the document) move. `root` is applied last. Throws Error(bad_input) for cycles, several parents and excessive
/// depth.
NodeTree read_nodes(const GltfDocument& document, const std::map<int, NodeCurves>& curves,
                    const glm::dmat4& root);

/// Reads each skin once, when it is first asked for.
class SkinReader {
 public:
  SkinReader(const GltfDocument& document, const NodeTree& tree);

  /// Throws Error(bad_input) for joints that are not among the tree's nodes, inverse bind matrices of another kind or fewer
  /// than joints, and more joints than the bounds allow.
  std::shared_ptr<const Skin> read(int index);

 private:
  const GltfDocument& document_;
  std::vector<std::optional<std::size_t>> in_tree_;  ///< of each node of the document
  std::map<int, std::shared_ptr<const Skin>> skins_;
  std::size_t joints_ = 0;
};

/// Appends the meshes of all nodes of `motion.tree` to the scene's vertices and triangles, as they are in `posed`: positions
/// in metres, unit normals, texture coordinates as each material maps them. A mirrored node keeps its outside outside; morph
/// targets and skins bend what has them. What moves becomes `motion.meshes` too. Points and lines get a note. Throws
/// Error(bad_input) for bad attributes and for more geometry than the bounds allow.
void append_meshes(const GltfDocument& document, PosedTree& posed, const MaterialSet& materials, Scene& scene,
                   Motion& motion, Notes& notes);

/// Appends the cameras and lights that the nodes of `motion.tree` carry, which `posed` places. Lengths of the file (near
/// planes, ranges) are in its units, of `metres_per_unit`; nodes' scales do not touch them, nor intensities. Names are made
/// unique. Those at nodes that move become `motion.cameras` and `motion.lights` too. Throws Error(bad_input).
void append_views(const GltfDocument& document, const PosedTree& posed, double metres_per_unit, Scene& scene,
                  Motion& motion, Notes& notes);

}  // namespace clpv
