// SPDX-License-Identifier: MIT
#include "scene/gltf_deformation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "scene/bounds.hpp"
#include "scene/gltf_accessor.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

class DeformationReader {
 public:
  DeformationReader(const GltfDocument& document, const tinygltf::Primitive& source,
                    LocalPrimitive& primitive)
      : document_(document), source_(source), primitive_(primitive) {}

  void read_influences() {
    const auto joints = attribute(source_.attributes, "JOINTS_0", 4, primitive_.place + "/attributes/");
    const auto weights = attribute(source_.attributes, "WEIGHTS_0", 4, primitive_.place + "/attributes/");
    if (joints.has_value() != weights.has_value()) {
      refuse(document_.file, primitive_.place + "/attributes",
             joints ? "JOINTS_0 without WEIGHTS_0" : "WEIGHTS_0 without JOINTS_0", "both or none");
    }
    if (!joints) return;
    check_joints(*joints);
    primitive_.influences.reserve(primitive_.vertices.size());
    for (const LocalVertex& vertex : primitive_.vertices)
      primitive_.influences.push_back(influence(*joints, *weights, vertex.source));
  }

  void read_targets(std::uint64_t& numbers) {
    for (std::size_t t = 0; t < source_.targets.size(); ++t) {
      const std::string place = fmt::format("{}/targets/{}/", primitive_.place, t);
      const auto positions = attribute(source_.targets[t], "POSITION", 3, place);
      const auto normals = attribute(source_.targets[t], "NORMAL", 3, place);
      const std::uint64_t count =
          primitive_.vertices.size() * ((positions ? 3u : 0u) + (normals && !primitive_.flat ? 3u : 0u));
      numbers += count;
      if (numbers > bounds::kMorphNumbers) {
        refuse(document_.file, place + "POSITION", fmt::format("{} numbers of morph targets so far", numbers),
               fmt::format("at most {}", bounds::kMorphNumbers));
      }
      MorphTarget target;
      if (positions) target.positions = read_vectors(*positions, place + "POSITION");
      if (normals && !primitive_.flat) target.normals = read_vectors(*normals, place + "NORMAL");
      primitive_.targets.push_back(std::move(target));
    }
  }

 private:
  std::optional<GltfAccessor> attribute(const std::map<std::string, int>& attributes, const std::string& name,
                                        int components, const std::string& place) const {
    const auto found = attributes.find(name);
    if (found == attributes.end()) return std::nullopt;
    GltfAccessor accessor(document_, found->second);
    const std::size_t wanted = GltfAccessor(document_, source_.attributes.at("POSITION")).count();
    if (accessor.components() != components || accessor.count() != wanted ||
        document_.model.accessors[static_cast<std::size_t>(found->second)].type > TINYGLTF_TYPE_VEC4) {
      refuse(document_.file, place + name,
             fmt::format("{} elements of {} components", accessor.count(), accessor.components()),
             fmt::format("VEC{}, as many as POSITION, {}", components, wanted));
    }
    return accessor;
  }

  void check_joints(const GltfAccessor& joints) const {
    const int type = joints.component_type();
    if (joints.normalized() ||
        (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT)) {
      refuse(document_.file, primitive_.place + "/attributes/JOINTS_0",
             fmt::format("componentType {}{}", type, joints.normalized() ? ", normalized" : ""),
             "5121 or 5123, not normalized");
    }
  }

  /// Shares that add up to 1; where there are none, the first joint has all.
  Influence influence(const GltfAccessor& joints, const GltfAccessor& weights, std::uint32_t vertex) const {
    Influence made{};
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
      const double weight = weights.number(vertex, i);
      if (!(weight >= 0 && weight <= kMostWeight)) {
        refuse(document_.file, primitive_.place + "/attributes/WEIGHTS_0",
               fmt::format("{} in component {} of vertex {}", weight, i, vertex),
               fmt::format("0 to {}", kMostWeight));
      }
      made.joints[i] = static_cast<std::uint16_t>(joints.index(vertex, i));
      made.weights[i] = weight;
      sum += weight;
    }
    for (double& weight : made.weights) weight = sum > 0 ? weight / sum : 0;
    if (sum == 0) made.weights[0] = 1;
    return made;
  }

  std::vector<glm::vec3> read_vectors(const GltfAccessor& from, const std::string& place) const {
    std::vector<glm::vec3> made;
    made.reserve(primitive_.vertices.size());
    for (const LocalVertex& vertex : primitive_.vertices) {
      glm::vec3 v;
      for (int i = 0; i < 3; ++i) {
        v[i] = static_cast<float>(from.number(vertex.source, i));
        if (!std::isfinite(v[i])) {
          refuse(document_.file, place,
                 fmt::format("{} in component {} of vertex {}", v[i], i, vertex.source), "finite numbers");
        }
      }
      made.push_back(v);
    }
    return made;
  }

  static constexpr double kMostWeight = 1e6;  // they are made to add up to 1

  const GltfDocument& document_;
  const tinygltf::Primitive& source_;
  LocalPrimitive& primitive_;
};

}  // namespace

void read_deformation(const GltfDocument& document, const tinygltf::Primitive& source,
                      LocalPrimitive& primitive, std::uint64_t& numbers, Notes& notes) {
  if (primitive.vertices.empty()) return;
  DeformationReader reader(document, source, primitive);
  reader.read_influences();
  reader.read_targets(numbers);
  if (source.attributes.contains("JOINTS_1")) {
    notes.add(
        fmt::format("{}: more than four joints a vertex: those of JOINTS_0 alone are read", primitive.place));
  }
}

}  // namespace clpv
