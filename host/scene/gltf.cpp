// SPDX-License-Identifier: MIT
#include "scene/gltf.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <future>
#include <glm/gtc/matrix_transform.hpp>

#include "scene/gltf_parts.hpp"
#include "support/error.hpp"

namespace clpv {

Scene load_gltf(const std::filesystem::path& path, double metres_per_unit, Motion& motion, Notes& notes) {
  const GltfDocument document = read_gltf_document(path);
  std::vector<std::string> ignored = document.model.extensionsUsed;
  std::erase_if(ignored, reads_extension);
  if (!ignored.empty()) notes.add(fmt::format("extensions used but not read: {}", fmt::join(ignored, ", ")));
  Scene scene;
  motion.tree = read_nodes(document, read_animations(document, notes),
                           glm::scale(glm::dmat4(1.0), glm::dvec3(metres_per_unit)));
  PosedTree posed(motion.tree, 0);
  const MaterialSet materials = read_materials(document, notes);
  auto textures = std::async(std::launch::async, [&] { return load_textures(document, materials.textures); });
  append_meshes(document, posed, materials, scene, motion, notes);  // while the images are decoded
  append_views(document, posed, metres_per_unit, scene, motion, notes);
  scene.textures = textures.get();
  scene.materials = materials.materials;
  const auto last = static_cast<std::uint32_t>(scene.materials.size() - 1);  // glTF's default material
  if (std::none_of(scene.triangles.begin(), scene.triangles.end(),
                   [&](auto& t) { return t.material == last; })) {
    scene.materials.pop_back();
  }
  return scene;
}

}  // namespace clpv
