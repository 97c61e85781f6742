// SPDX-License-Identifier: MIT
#include "scene/gltf_skin.hpp"

#include <cmath>

#include "scene/bounds.hpp"
#include "scene/gltf_accessor.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

std::vector<glm::dmat4> read_inverse_binds(const GltfDocument& document, int accessor, std::size_t joints,
                                           const std::string& place) {
  if (accessor < 0) return std::vector<glm::dmat4>(joints, glm::dmat4(1.0));
  const GltfAccessor from(document, accessor);
  if (document.model.accessors[static_cast<std::size_t>(accessor)].type != TINYGLTF_TYPE_MAT4 ||
      from.component_type() != TINYGLTF_COMPONENT_TYPE_FLOAT || from.count() < joints) {
    refuse(document.file, place,
           fmt::format("{}, {} elements of {} components of componentType {}", from.place(), from.count(),
                       from.components(), from.component_type()),
           fmt::format("MAT4 of floats (componentType 5126), one for each of {} joints", joints));
  }
  std::vector<glm::dmat4> made(joints);
  for (std::size_t i = 0; i < joints; ++i) {
    for (int k = 0; k < 16; ++k) {
      const double value = from.number(i, k);
      if (!std::isfinite(value)) {
        refuse(document.file, place, fmt::format("{} in component {} of matrix {}", value, k, i),
               "finite numbers");
      }
      made[i][k / 4][k % 4] = value;
    }
  }
  return made;
}

}  // namespace

SkinReader::SkinReader(const GltfDocument& document, const NodeTree& tree)
    : document_(document), in_tree_(document.model.nodes.size()) {
  for (std::size_t i = 0; i < tree.nodes.size(); ++i)
    in_tree_[static_cast<std::size_t>(tree.nodes[i].index)] = i;
}

std::shared_ptr<const Skin> SkinReader::read(int index) {
  std::shared_ptr<const Skin>& known = skins_[index];
  if (known) return known;
  const tinygltf::Skin& source = document_.model.skins[static_cast<std::size_t>(index)];
  const std::string place = fmt::format("/skins/{}", index);
  joints_ += source.joints.size();
  if (joints_ > bounds::kJoints) {
    refuse(document_.file, place + "/joints", fmt::format("{} joints so far", joints_),
           fmt::format("at most {} in all skins", bounds::kJoints));
  }
  Skin skin;
  for (std::size_t i = 0; i < source.joints.size(); ++i) {
    const std::optional<std::size_t> node = in_tree_[static_cast<std::size_t>(source.joints[i])];
    if (!node) {
      refuse(document_.file, fmt::format("{}/joints/{}", place, i),
             fmt::format("node {}, which is not in the scene", source.joints[i]), "nodes of the scene");
    }
    skin.joints.push_back(*node);
  }
  skin.inverse_binds = read_inverse_binds(document_, source.inverseBindMatrices, skin.joints.size(),
                                          place + "/inverseBindMatrices");
  return known = std::make_shared<const Skin>(std::move(skin));
}

}  // namespace clpv
