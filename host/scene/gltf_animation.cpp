// SPDX-License-Identifier: MIT
#include "scene/gltf_animation.hpp"

#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <nlohmann/json.hpp>
#include <tuple>

#include "scene/bounds.hpp"
#include "scene/gltf_accessor.hpp"
#include "scene/gltf_path.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

using nlohmann::json;
using CurvePointer = std::shared_ptr<const Curve>;

class AnimationReader {
 public:
  AnimationReader(const GltfDocument& document, Notes& notes) : document_(document), notes_(notes) {}

  /// `place`: "/animations/0".
  void read(const json& animation, const std::string& place) {
    std::map<std::tuple<std::size_t, GltfPath, std::size_t>, CurvePointer>
        read;  // channels may share a sampler
    for (std::size_t i = 0; i < animation["channels"].size(); ++i) {
      const json& channel = animation["channels"][i];
      const std::string here = fmt::format("{}/channels/{}", place, i);
      const auto path = named<GltfPath>("path", channel["target"]["path"].get_ref<const std::string&>());
      const std::size_t sampler = channel["sampler"], samplers = animation["samplers"].size();
      if (sampler >= samplers) {
        refuse(document_.file, here + "/sampler", fmt::format("{}", sampler),
               fmt::format("an index into {}/samplers, 0 to {}", place, samplers - 1));
      }
      if (!channel["target"].contains("node")) continue;  // of an extension that is not read
      const int node = channel["target"]["node"];
      const std::size_t components = components_of(path, node);
      if (components == 0) {
        notes_.add(fmt::format("{}: animates {} of node {}, which has none that are read", here,
                               name_of(path), node));
        continue;
      }
      CurvePointer& curve = read[{sampler, path, components}];
      if (!curve) {
        curve = read_curve(animation["samplers"][sampler], path, components,
                           fmt::format("{}/samplers/{}", place, sampler));
      }
      assign(node, path, curve, here);
    }
  }

  std::map<int, NodeCurves> take() { return std::move(nodes_); }

 private:
  /// Numbers a key has; 0: nothing of the node that is read.
  std::size_t components_of(GltfPath path, int node) const {
    switch (path) {
      case GltfPath::translation:
      case GltfPath::scale:
        return 3;
      case GltfPath::rotation:
        return 4;
      case GltfPath::weights: {
        const int mesh = document_.model.nodes[static_cast<std::size_t>(node)].mesh;
        return mesh < 0 ? 0
                        : document_.model.meshes[static_cast<std::size_t>(mesh)].primitives[0].targets.size();
      }
      case GltfPath::pointer:
        return 0;
    }
    return 0;
  }

  void assign(int node, GltfPath path, const CurvePointer& curve, const std::string& place) {
    if (path != GltfPath::weights && !document_.model.nodes[static_cast<std::size_t>(node)].matrix.empty()) {
      refuse(document_.file, place + "/target/node", fmt::format("node {}, which has a matrix", node),
             "a node with translation, rotation and scale");
    }
    CurvePointer& taken = curve_of(nodes_[node], path);
    if (taken) return notes_.add(fmt::format("{}: node {} is moved by an earlier channel", place, node));
    taken = curve;
  }

  static CurvePointer& curve_of(NodeCurves& curves, GltfPath path) {
    switch (path) {
      case GltfPath::rotation:
        return curves.rotation;
      case GltfPath::scale:
        return curves.scale;
      case GltfPath::weights:
        return curves.weights;
      case GltfPath::translation:
      case GltfPath::pointer:
        break;
    }
    return curves.translation;
  }

  CurvePointer read_curve(const json& sampler, GltfPath path, std::size_t components,
                          const std::string& place) {
    const GltfAccessor input(document_, sampler["input"].get<int>()),
        output(document_, sampler["output"].get<int>());
    Curve curve;
    curve.interpolation =
        named<Interpolation>("interpolation", sampler.value("interpolation", std::string("LINEAR")));
    curve.components = components;
    check_kinds(sampler, input, output, path, place);
    const std::size_t parts = curve.interpolation == Interpolation::cubic_spline ? 3 : 1;
    const std::size_t elements = path == GltfPath::weights ? parts * components : parts;  // of a key
    if (output.count() != input.count() * elements) {
      refuse(document_.file, place + "/output", fmt::format("{} elements", output.count()),
             fmt::format("{} for each of the {} times of its input", elements, input.count()));
    }
    reserve(input.count() * (1 + parts * components), place);
    read_times(input, curve, place + "/input");
    read_values(output, curve, place + "/output");
    if (path == GltfPath::rotation) make_unit(curve, parts, place + "/output");
    return std::make_shared<const Curve>(std::move(curve));
  }

  void check_kinds(const json& sampler, const GltfAccessor& input, const GltfAccessor& output, GltfPath path,
                   const std::string& place) const {
    const auto kind = [&](const GltfAccessor& accessor, const char* key) {
      const int index = sampler[key].get<int>();
      return fmt::format("{}, {} components of componentType {}{}", accessor.place(), accessor.components(),
                         document_.model.accessors[static_cast<std::size_t>(index)].componentType,
                         accessor.normalized() ? ", normalized" : "");
    };
    const auto is_float = [](const GltfAccessor& accessor) {
      return accessor.component_type() == TINYGLTF_COMPONENT_TYPE_FLOAT && !accessor.normalized();
    };
    if (input.components() != 1 || !is_float(input)) {
      refuse(document_.file, place + "/input", kind(input, "input"), "SCALAR of floats (componentType 5126)");
    }
    const bool integers = path == GltfPath::rotation || path == GltfPath::weights;
    const auto type = document_.model.accessors[static_cast<std::size_t>(sampler["output"].get<int>())].type;
    const auto [wanted, name] = path == GltfPath::rotation  ? std::pair(TINYGLTF_TYPE_VEC4, "VEC4")
                                : path == GltfPath::weights ? std::pair(TINYGLTF_TYPE_SCALAR, "SCALAR")
                                                            : std::pair(TINYGLTF_TYPE_VEC3, "VEC3");
    if (type != wanted || !(is_float(output) || (integers && output.normalized()))) {
      refuse(document_.file, place + "/output", kind(output, "output"),
             fmt::format("{} of floats (componentType 5126){}", name,
                         integers ? " or normalized integers" : ""));
    }
  }

  void reserve(std::uint64_t numbers, const std::string& place) {
    numbers_ += numbers;
    if (numbers_ > bounds::kKeyNumbers) {
      refuse(document_.file, place, fmt::format("{} times and values of all animations so far", numbers_),
             fmt::format("at most {}", bounds::kKeyNumbers));
    }
  }

  void read_times(const GltfAccessor& input, Curve& curve, const std::string& place) const {
    curve.times.reserve(input.count());
    for (std::size_t i = 0; i < input.count(); ++i) {
      const double time = input.number(i, 0);
      if (!std::isfinite(time) || time < 0) {
        refuse(document_.file, place, fmt::format("{} s at {}", time, i), "finite times from 0 s on");
      }
      if (i > 0 && time <= curve.times.back()) {
        refuse(document_.file, place, fmt::format("{} s at {}, after {} s", time, i, curve.times.back()),
               "times that rise from each to the next");
      }
      curve.times.push_back(time);
    }
  }

  void read_values(const GltfAccessor& output, Curve& curve, const std::string& place) const {
    curve.values.reserve(output.count() * static_cast<std::size_t>(output.components()));
    for (std::size_t i = 0; i < output.count(); ++i) {
      for (int k = 0; k < output.components(); ++k) {
        curve.values.push_back(output.number(i, k));
        if (!std::isfinite(curve.values.back())) {
          refuse(document_.file, place,
                 fmt::format("{} in component {} of element {}", curve.values.back(), k, i),
                 "finite numbers");
        }
      }
    }
  }

  /// Of a cubic spline's, the values: tangents are no rotations, and stay as they are.
  void make_unit(Curve& curve, std::size_t parts, const std::string& place) const {
    for (std::size_t key = 0; key < curve.times.size(); ++key) {
      const std::size_t element = parts * key + parts / 2;
      double* v = &curve.values[4 * element];
      const double length = glm::length(glm::dquat(v[3], v[0], v[1], v[2]));
      if (length < 0.5) {
        refuse(document_.file, place, fmt::format("a quaternion of length {} at {}", length, element),
               "unit quaternions");
      }
      for (int i = 0; i < 4 && parts == 1; ++i) v[i] /= length;
    }
  }

  const GltfDocument& document_;
  Notes& notes_;
  std::uint64_t numbers_ = 0;
  std::map<int, NodeCurves> nodes_;
};

}  // namespace

std::map<int, NodeCurves> read_animations(const GltfDocument& document, Notes& notes) {
  AnimationReader reader(document, notes);
  for (std::size_t i = 0; document.animations && i < document.animations->size(); ++i) {
    reader.read((*document.animations)[i], fmt::format("/animations/{}", i));
  }
  return reader.take();
}

}  // namespace clpv
