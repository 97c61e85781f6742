// SPDX-License-Identifier: MIT
// Reads the instances of EXT_mesh_gpu_instancing: one mesh many times at one node.
#include <fmt/ranges.h>

#include "scene/bounds.hpp"
#include "scene/gltf_accessor.hpp"
#include "scene/gltf_parts.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr const char* kExtension = "EXT_mesh_gpu_instancing";

/// One attribute of the instances of a node.
struct Attribute {
  const char* name;
  int type;
  const ComponentTypes& numbers;
};

constexpr Attribute kTranslation{"TRANSLATION", TINYGLTF_TYPE_VEC3, kFloats},
    kRotation{"ROTATION", TINYGLTF_TYPE_VEC4, kFractions},
    kScale{"SCALE", TINYGLTF_TYPE_VEC3, kFloats};

/// Attributes of a node's instances, which have one element each.
class InstanceReader {
 public:
  InstanceReader(const GltfDocument& document, int node, const tinygltf::Value& attributes)
      : document_(document),
        place_(fmt::format("/nodes/{}/extensions/{}/attributes", node, kExtension)),
        translations_(find(attributes, kTranslation)),
        rotations_(find(attributes, kRotation)),
        scales_(find(attributes, kScale)) {
    if (!count_) reject(document.file, place_, "no attribute", "TRANSLATION, ROTATION or SCALE");
  }

  std::size_t count() const { return *count_; }
  const std::string& place() const { return place_; }

  glm::dmat4 matrix(std::size_t instance) const {
    Pose pose;
    if (translations_) pose.translation = vector_in(*translations_, instance);
    if (scales_) pose.scale = vector_in(*scales_, instance);
    if (!rotations_) return pose.matrix();
    const auto part = [&](int component) { return rotations_->finite(instance, component); };
    const glm::dquat rotation(part(3), part(0), part(1), part(2));  // stored as x, y, z, w
    if (!(glm::length(rotation) > 0.5)) {
      rotations_->reject_element(instance,
                                 fmt::format("a quaternion of length {}", glm::length(rotation)),
                                 "unit quaternions");
    }
    pose.rotation = glm::normalize(rotation);
    return pose.matrix();
  }

 private:
  std::optional<GltfAccessor> find(const tinygltf::Value& attributes, const Attribute& wanted) {
    if (!attributes.Has(wanted.name)) return std::nullopt;
    GltfAccessor found(document_, attributes.Get(wanted.name).GetNumberAsInt(),
                       place_ + "/" + wanted.name, {wanted.type}, wanted.numbers, count_);
    count_ = found.count();
    return found;
  }

  const GltfDocument& document_;
  std::string place_;
  std::optional<std::size_t> count_;  ///< elements of the attributes so far
  std::optional<GltfAccessor> translations_, rotations_, scales_;
};

/// Names of attributes that are not read, such as colours.
std::vector<std::string> others_in(const tinygltf::Value& attributes) {
  std::vector<std::string> names =
      attributes.IsObject() ? attributes.Keys() : std::vector<std::string>();
  std::erase_if(names, [](const std::string& name) {
    return name == kTranslation.name || name == kRotation.name || name == kScale.name;
  });
  return names;
}

}  // namespace

std::vector<std::optional<glm::dmat4>> read_instances(const GltfDocument& document, int node,
                                                      std::size_t& budget, Notes& notes) {
  const tinygltf::Node& source = entry(document.model.nodes, node);
  const auto found = source.extensions.find(kExtension);
  if (found == source.extensions.end()) return {std::nullopt};
  const tinygltf::Value& attributes = found->second.Get("attributes");
  const InstanceReader reader(document, node, attributes);
  if (reader.count() > budget) {
    reject(document.file, reader.place(), fmt::format("{} more instances", reader.count()),
           fmt::format("at most {} in all", bounds::kInstances));
  }
  budget -= reader.count();
  if (const auto others = others_in(attributes); !others.empty())
    notes.add(fmt::format("{}: not read: {}", reader.place(), fmt::join(others, ", ")));
  if (source.skin >= 0) {
    notes.add(fmt::format("{}: a skin places the mesh, which is drawn once", reader.place()));
    return {std::nullopt};
  }
  std::vector<std::optional<glm::dmat4>> made;
  made.reserve(reader.count());
  for (std::size_t i = 0; i < reader.count(); ++i) made.push_back(reader.matrix(i));
  return made;
}

}  // namespace clpv
