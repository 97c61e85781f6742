// SPDX-License-Identifier: MIT
// The parts of a glTF document, each as a scene has it. Internal to the loader.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "scene/gltf_document.hpp"
#include "scene/motion.hpp"
#include "scene/notes.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// How a vertex's texture coordinates come about: set TEXCOORD_n, then uv' = transform (u, v, 1).
struct UvMapping {
  int set = 0;
  glm::dmat3 transform{1.0};
  friend bool operator==(const UvMapping&, const UvMapping&) = default;
};

/// One texture to be made: an image seen through a sampler.
struct TextureRequest {
  int image;
  std::uint32_t wrap_u, wrap_v;
  friend bool operator==(const TextureRequest&, const TextureRequest&) = default;
};

struct MaterialSet {
  std::vector<Material> materials;       ///< those of the document in its order, then glTF's default material
  std::vector<UvMapping> mappings;       ///< one a material
  std::vector<TextureRequest> textures;  ///< Material::texture indexes these
};

/// Throws Error(bad_input).
MaterialSet read_materials(const GltfDocument& document, Notes& notes);

/// Decodes each requested image (PNG or JPEG, told by its first bytes, not by name or mimeType) on all cores, where its header
/// keeps the bounds.
/// Row 0 is v = 0. Throws Error(bad_input) for the first bad one in the document's order.
std::vector<Texture> load_textures(const GltfDocument& document, const std::vector<TextureRequest>& requests);

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
