// SPDX-License-Identifier: MIT
// Readers of the parts of a glTF document: animations, nodes, skins, meshes, cameras and lights.
// Internal to the loader.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "scene/gltf_document.hpp"
#include "scene/input.hpp"
#include "scene/motion.hpp"
#include "scene/primitive.hpp"
#include "scene/scene.hpp"

namespace clpv {

/// Texture coordinates of a material: uv' = transform (u, v, 1) with (u, v) from attribute
/// TEXCOORD_set.
struct UvMapping {
  int set = 0;
  glm::dmat3 transform{1.0};
  friend bool operator==(const UvMapping&, const UvMapping&) = default;
};

/// A texture to load: an image and its wrap modes.
struct TextureRequest {
  int image;
  std::uint32_t wrap_u, wrap_v;
  friend bool operator==(const TextureRequest&, const TextureRequest&) = default;
};

struct MaterialSet {
  /// The document's materials in order, then glTF's default material.
  std::vector<ClpvMaterial> materials;
  std::vector<UvMapping> mappings;       ///< one per material
  std::vector<TextureRequest> textures;  ///< indexed by Material::texture
};

/// Throws Error(bad_input).
MaterialSet read_materials(const GltfDocument& document, Notes& notes);

/// Decodes the requested images on all cores after checks of their headers. The first bytes of an
/// image determine whether it is PNG, JPEG or WebP. Row 0 is v = 0. Throws Error(bad_input) for the
/// first invalid image in the document's order.
std::vector<Texture> load_textures(const GltfDocument& document,
                                   const std::vector<TextureRequest>& requests);

/// Curves of animated nodes, by node index. All animations play simultaneously. If several animate
/// the same property of a node, the first does, with a note. Throws Error(bad_input) for invalid
/// accessors, times that are negative, not finite or not rising, quaternions of length below 0.5,
/// and more numbers than the bounds allow.
std::map<int, NodeCurves> read_animations(const GltfDocument& document, Notes& notes);

/// Nodes of the default scene, parents first: else of the first scene, or below all root nodes
/// without scenes. Notes a first scene among several. `curves` are by node index; `root` transforms
/// the model to world space. Throws Error(bad_input) for cycles, several parents and excessive
/// depth.
NodeTree read_nodes(const GltfDocument& document, const std::map<int, NodeCurves>& curves,
                    const glm::dmat4& root, Notes& notes);

/// Transforms of the instances of a node's mesh to the node's space, by EXT_mesh_gpu_instancing;
/// else one without a transform. Subtracts from `budget`, the instances that the model may still
/// have. Throws Error(bad_input).
std::vector<std::optional<glm::dmat4>> read_instances(const GltfDocument& document, int node,
                                                      std::size_t& budget, Notes& notes);

/// Reads and caches skins.
class SkinReader {
 public:
  SkinReader(const GltfDocument& document, const NodeTree& tree);

  /// Throws Error(bad_input) for joints outside the tree, invalid or missing inverse bind matrices,
  /// and more joints than the bounds allow.
  std::shared_ptr<const Skin> read(int index);

 private:
  const GltfDocument& document_;
  std::vector<std::optional<std::size_t>> in_tree_;  ///< position in the tree, by node index
  std::map<int, std::shared_ptr<const Skin>> skins_;
  std::size_t joints_ = 0;
};

/// Appends the meshes of all nodes of `motion.tree` to the scene, posed by `posed`, with morph
/// targets and skins applied, once per instance. Positions are in metres, normals unit, texture
/// coordinates mapped by materials. Mirrored nodes keep their fronts outside. Moving instances are
/// also added to `motion.meshes`; points and lines get a note. Throws Error(bad_input) for invalid
/// attributes and for more geometry than the bounds allow.
void append_meshes(const GltfDocument& document, PosedTree& posed, const MaterialSet& materials,
                   SceneData& scene, Motion& motion, Notes& notes);

/// Where notes on cameras and on lights go.
struct ViewNotes {
  Notes &cameras, &lights;
};

/// Appends the cameras and lights of the nodes of `motion.tree`, posed by `posed`, with unique
/// names. `metres_per_unit` scales near planes and ranges; scales of nodes do not. Cameras and
/// lights at moving nodes are also added to `motion`. Throws Error(bad_input).
void append_views(const GltfDocument& document, const PosedTree& posed, double metres_per_unit,
                  SceneData& scene, Motion& motion, const ViewNotes& notes);

/// Reads primitive `index` of mesh `mesh` with joints, weights and morph targets; subtracts from
/// `budget.morph_numbers`. Points and lines give no triangles and a note. `slots` is scratch
/// memory, kNoSlot between calls, as primitives often share one large accessor. Throws
/// Error(bad_input).
LocalPrimitive read_primitive(const GltfDocument& document, int mesh, std::size_t index,
                              const MaterialSet& materials, GeometryBudget& budget,
                              std::vector<std::uint32_t>& slots, Notes& notes);

}  // namespace clpv
