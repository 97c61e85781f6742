// SPDX-License-Identifier: MIT
// Reads glTF animations as curves of nodes.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <tuple>

#include "scene/bounds.hpp"
#include "scene/gltf_accessor.hpp"
#include "scene/gltf_parts.hpp"
#include "support/error.hpp"
#include "support/named_enum.hpp"

namespace clpv {
namespace {

using CurvePointer = std::shared_ptr<const Curve>;

/// An animated property of a node: its path in glTF, type and component types of the sampler's
/// output, and its curve.
struct Target {
  std::string_view path;
  int type;
  ComponentTypes numbers;
  CurvePointer NodeCurves::*curve;
};

constexpr std::array<Target, 4> kAnimatedProperties = {
    {{"translation", TINYGLTF_TYPE_VEC3, kFloats, &NodeCurves::translation},
     {"rotation", TINYGLTF_TYPE_VEC4, kFractions, &NodeCurves::rotation},
     {"scale", TINYGLTF_TYPE_VEC3, kFloats, &NodeCurves::scale},
     {"weights", TINYGLTF_TYPE_SCALAR, kFractions, &NodeCurves::weights}}};

class AnimationReader {
 public:
  AnimationReader(const GltfDocument& document, Notes& notes)
      : document_(document), notes_(notes) {}

  /// `place`: "/animations/0". Messages do not number channels, as tinygltf omits those without a
  /// node.
  void read(const tinygltf::Animation& animation, const std::string& place) {
    // By sampler, path and size, as channels may share a sampler.
    std::map<std::tuple<int, std::string_view, std::size_t>, CurvePointer> curves;
    for (const tinygltf::AnimationChannel& channel : animation.channels) {
      const auto target =
          std::ranges::find(kAnimatedProperties, channel.target_path, &Target::path);
      if (target == kAnimatedProperties.end()) continue;  // extensions
      const int count = static_cast<int>(animation.samplers.size());
      if (channel.sampler >= count) {
        reject(document_.file, place + "/channels", fmt::format("sampler {}", channel.sampler),
               fmt::format("0 to {}, the samplers of {}", count - 1, place));
      }
      const std::size_t components = components_of(*target, channel.target_node);
      if (components == 0) {
        notes_.add(fmt::format("{}: animates {} of node {}, which has no such property", place,
                               target->path, channel.target_node));
        continue;
      }
      CurvePointer& curve = curves[{channel.sampler, target->path, components}];
      if (!curve) {
        curve = read_curve(entry(animation.samplers, channel.sampler), *target, components,
                           fmt::format("{}/samplers/{}", place, channel.sampler));
      }
      assign(channel.target_node, *target, curve, place);
    }
  }

  std::map<int, NodeCurves> take() { return std::move(nodes_); }

 private:
  /// Numbers per key; 0 for weights of a node without mesh or morph targets.
  std::size_t components_of(const Target& target, int node) const {
    if (target.type == TINYGLTF_TYPE_VEC3) return 3;
    if (target.type == TINYGLTF_TYPE_VEC4) return 4;
    const int mesh = entry(document_.model.nodes, node).mesh;
    return mesh < 0 ? 0 : entry(document_.model.meshes, mesh).primitives[0].targets.size();
  }

  void assign(int node, const Target& target, const CurvePointer& curve, const std::string& place) {
    if (target.type != TINYGLTF_TYPE_SCALAR && !entry(document_.model.nodes, node).matrix.empty()) {
      reject(document_.file, fmt::format("/nodes/{}/matrix", node),
             fmt::format("a matrix, and a {} by {}", target.path, place),
             "translation, rotation and scale");
    }
    CurvePointer& assigned = nodes_[node].*target.curve;
    if (assigned)
      return notes_.add(fmt::format("{}: node {} is moved by an earlier channel", place, node));
    assigned = curve;
  }

  CurvePointer read_curve(const tinygltf::AnimationSampler& sampler, const Target& target,
                          std::size_t components, const std::string& place) {
    Curve curve;
    curve.interpolation = named<Interpolation>("interpolation", sampler.interpolation);
    curve.components = components;
    const std::size_t parts = curve.interpolation == Interpolation::cubic_spline ? 3 : 1;
    const bool scalars = target.type == TINYGLTF_TYPE_SCALAR;
    const GltfAccessor input(document_, sampler.input, place + "/input", {TINYGLTF_TYPE_SCALAR},
                             kFloats);
    const GltfAccessor output(document_, sampler.output, place + "/output", {target.type},
                              target.numbers, input.count() * parts * (scalars ? components : 1));
    reserve(input.count() * (1 + parts * components), place);
    read_times(input, curve, place + "/input");
    curve.values.reserve(input.count() * parts * components);
    for (std::size_t i = 0; i < output.count(); ++i) {
      for (int k = 0; k < output.components(); ++k) curve.values.push_back(output.finite(i, k));
    }
    if (target.curve == &NodeCurves::rotation) normalise_rotations(curve, parts, place + "/output");
    return std::make_shared<const Curve>(std::move(curve));
  }

  void reserve(std::uint64_t numbers, const std::string& place) {
    numbers_ += numbers;
    if (numbers_ > bounds::kKeyNumbers) {
      reject(document_.file, place,
             fmt::format("{} times and values of all animations so far", numbers_),
             fmt::format("at most {}", bounds::kKeyNumbers));
    }
  }

  void read_times(const GltfAccessor& input, Curve& curve, const std::string& place) const {
    curve.times.reserve(input.count());
    for (std::size_t i = 0; i < input.count(); ++i) {
      const double time = input.finite(i, 0);
      if (i == 0 ? time < 0 : time <= curve.times.back()) {
        reject(document_.file, place, fmt::format("{} s at {}", time, i),
               i == 0 ? "times from 0 s on"
                      : fmt::format("more than the {} s before", curve.times.back()));
      }
      curve.times.push_back(time);
    }
  }

  /// Checks that values are quaternions, and normalises those of curves other than cubic splines.
  void normalise_rotations(Curve& curve, std::size_t parts, const std::string& place) const {
    for (std::size_t key = 0; key < curve.times.size(); ++key) {
      const std::size_t element = parts * key + parts / 2;
      double* v = &curve.values[4 * element];
      const double length = glm::length(glm::dquat(v[3], v[0], v[1], v[2]));
      if (length < 0.5) {
        reject(document_.file, place,
               fmt::format("a quaternion of length {} at {}", length, element), "unit quaternions");
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
  for (std::size_t i = 0; i < document.model.animations.size(); ++i)
    reader.read(document.model.animations[i], fmt::format("/animations/{}", i));
  return reader.take();
}

}  // namespace clpv
