// SPDX-License-Identifier: MIT
// Meshes from memory in a scene: added, moved and removed.
#pragma once

#include <map>
#include <optional>
#include <span>

#include "clpv/mesh.hpp"
#include "scene/motion.hpp"

namespace clpv {

/// The meshes from memory of one scene, behind those of its file. Arguments and errors are those of
/// clpv::Scene; after an error, nothing has changed. Copies share vertices until one of them
/// changes.
class AddedMeshes {
 public:
  int add(const Mesh& mesh, const Transform& transform, SceneData& scene);
  int add_instance(int mesh, const Transform& transform, SceneData& scene);
  void remove(int mesh, SceneData& scene);

  /// Return true if the mesh moves for the first time, so that SceneData::moving is longer.
  bool set_positions(int mesh, std::span<const std::array<float, 3>> positions,
                     std::span<const std::array<float, 3>> normals, SceneData& scene);
  bool set_transform(int mesh, const Transform& transform, SceneData& scene);

 private:
  /// A mesh at a place. Those at several places share the primitive.
  struct Added {
    Instance instance;
    NodeTree tree;          ///< a tree of one node
    std::size_t positions;  ///< vertices that were given
    bool moves = false;
  };
  /// Parts of the scene that come from its file.
  struct FileParts {
    std::size_t materials, textures, moving;
  };

  Added& entry(const char* function, int mesh);
  int append(Added added, SceneData& scene);
  std::uint32_t texture_slot(const Material::Texture& texture, SceneData& scene) const;
  std::uint32_t material_slot(const Material& material, SceneData& scene) const;
  bool uses_material(std::size_t slot) const;
  bool uses_texture(std::size_t slot, const SceneData& scene) const;
  void list_moving(SceneData& scene) const;

  std::map<int, Added> meshes_;  ///< by number, in the scene's order
  int next_ = 0;
  std::optional<FileParts> file_;  ///< set by the first add()
};

}  // namespace clpv
