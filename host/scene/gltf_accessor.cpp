// SPDX-License-Identifier: MIT
// Reads elements of accessors, checked against their buffer views.

#include "scene/gltf_accessor.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "scene/bounds.hpp"
#include "scene/gltf_parts.hpp"
#include "scene/scene.hpp"
#include "support/error.hpp"

namespace clpv {

// Reads the cameras and lights of a glTF document.

namespace {

class ViewReader {
 public:
  ViewReader(const GltfDocument& document, double metres_per_unit, SceneData& scene,
             const ViewNotes& notes)
      : document_(document), metres_per_unit_(metres_per_unit), scene_(scene), notes_(notes) {
    const tinygltf::Model& model = document.model;
    for (const auto& camera : model.cameras) cameras_.reserve(camera.name);
    for (const auto& light : model.lights) lights_.reserve(light.name);
    for (const auto& node : model.nodes) cameras_.reserve(node.name), lights_.reserve(node.name);
  }

  /// Appends the camera of a node. Returns false for an orthographic one.
  bool camera(int node, const tinygltf::Node& source, const glm::dmat4& to_world) {
    const tinygltf::Camera& given = entry(document_.model.cameras, source.camera);
    const std::string place = fmt::format("/cameras/{}", source.camera);
    if (given.type != "perspective") {
      notes_.cameras.add(fmt::format("{} ('{}') is orthographic: not read", place, given.name));
      return false;
    }
    if (scene_.cameras.size() == bounds::kCameras) {
      reject(document_.file, place_of(node), "one more camera",
             fmt::format("at most {}", bounds::kCameras));
    }
    SceneCamera made;
    made.name = cameras_.unique(given.name.empty() ? source.name : given.name, "camera");
    place_camera(made, to_world, document_.file, node);
    made.vertical_fov = static_cast<float>(given.perspective.yfov);
    made.near_depth = static_cast<float>(given.perspective.znear * metres_per_unit_);
    scene_.cameras.push_back(made);
    return true;
  }

  void light(int node, const tinygltf::Node& source, int index, const glm::dmat4& to_world) {
    const tinygltf::Light& given = entry(document_.model.lights, index);
    if (scene_.lights.size() == bounds::kLights) {
      reject(document_.file, place_of(node), "one more light",
             fmt::format("at most {}", bounds::kLights));
    }
    SceneLight made;
    made.name = lights_.unique(given.name.empty() ? source.name : given.name, "light");
    ClpvLight& data = made.data;
    const LightKind kind = named<LightKind>("type", given.type);
    data.kind = static_cast<unsigned>(kind);
    place_light(data, to_world, document_.file, node);
    for (std::size_t i = 0; i < 3; ++i) {
      data.intensity[i] =
          static_cast<float>(given.intensity * (given.color.empty() ? 1.0 : given.color[i]));
    }
    if (kind != LightKind::directional)
      data.range = static_cast<float>(given.range * metres_per_unit_);
    if (kind == LightKind::spot) {
      cone(data, given.spot, fmt::format("/extensions/KHR_lights_punctual/lights/{}/spot", index));
    }
    scene_.lights.push_back(made);
  }

  /// Adds notes on cameras and lights that share names.
  void finish() {
    cameras_.add_notes("camera", notes_.cameras);
    lights_.add_notes("light", notes_.lights);
  }

 private:
  /// Names in use, and those given to others of the same name.
  class Names {
   public:
    /// Keeps a name of the file from being made up for another.
    void reserve(const std::string& name) { reserved_.insert(name); }

    /// Returns `preferred`, or a name like it that is not in use, and uses it.
    std::string unique(const std::string& preferred, const char* kind) {
      std::string name = preferred.empty() ? fmt::format("{} {}", kind, used_.size()) : preferred;
      const auto taken = [&] {
        return used_.contains(name) || (name != preferred && reserved_.contains(name));
      };
      for (int i = 2; taken(); ++i)
        name = fmt::format("{} {}", preferred.empty() ? kind : preferred, i);
      used_.insert(name);
      if (!preferred.empty() && name != preferred) renamed_[preferred].push_back(name);
      return name;
    }

    void add_notes(const char* kind, Notes& notes) const {
      for (const auto& [name, others] : renamed_) {
        notes.add(fmt::format("{} {}s have the name '{}': the {} called '{}'{}", others.size() + 1,
                              kind, name, others.size() == 1 ? "second is" : "others are",
                              others.front(), others.size() == 1 ? "" : " and so on"));
      }
    }

   private:
    std::set<std::string> used_, reserved_;
    std::map<std::string, std::vector<std::string>> renamed_;
  };

  void cone(ClpvLight& light, const tinygltf::SpotLight& given, const std::string& place) {
    const double right_angle = std::numbers::pi / 2;  // the schema admits it rounded up
    const double inner = std::min(given.innerConeAngle, right_angle),
                 outer = std::min(given.outerConeAngle, right_angle);
    if (inner > outer) {
      reject(document_.file, place,
             fmt::format("innerConeAngle {} and outerConeAngle {}", inner, outer),
             "inner less than outer, or equal: a hard edge");
    }
    if (inner == outer)
      notes_.lights.add(fmt::format(
          "{}: innerConeAngle and outerConeAngle are both {}: a hard edge", place, inner));
    set_cone(light, inner, outer);
  }

  static std::string place_of(int node) { return fmt::format("/nodes/{}", node); }

  const GltfDocument& document_;
  double metres_per_unit_;
  SceneData& scene_;
  ViewNotes notes_;
  Names cameras_, lights_;
};

template <typename T>
T load(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

std::uint32_t load_unsigned(const std::uint8_t* from, int component_type) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return *from;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load<std::uint16_t>(from);
    default:
      return load<std::uint32_t>(from);
  }
}

template <typename T>
double load_integer(const std::uint8_t* from, bool normalized) {
  const double value = load<T>(from);
  return normalized ? std::max(value / static_cast<double>(std::numeric_limits<T>::max()), -1.0)
                    : value;
}

double load_number(const std::uint8_t* from, int component_type, bool normalized) {
  switch (component_type) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return load_integer<std::int8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return load_integer<std::uint8_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return load_integer<std::int16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return load_integer<std::uint16_t>(from, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load_integer<std::uint32_t>(from, normalized);
    default:
      return load<float>(from);
  }
}

std::size_t bytes_of(int component_type) {
  return static_cast<unsigned>(
      tinygltf::GetComponentSizeInBytes(static_cast<unsigned>(component_type)));
}

std::string type_name(int type) {
  if (type == TINYGLTF_TYPE_SCALAR) return "SCALAR";
  return fmt::format("{}{}", type > TINYGLTF_TYPE_VEC4 ? "MAT" : "VEC", type % 32);
}

}  // namespace

void append_views(const GltfDocument& document, const PosedTree& posed, double metres_per_unit,
                  SceneData& scene, Motion& motion, const ViewNotes& notes) {
  ViewReader reader(document, metres_per_unit, scene, notes);
  for (std::size_t i = 0; i < motion.tree.nodes.size(); ++i) {
    const TreeNode& node = motion.tree.nodes[i];
    const tinygltf::Node& source = entry(document.model.nodes, node.index);
    if (source.camera >= 0 && reader.camera(node.index, source, posed.unmirrored(i)) &&
        node.moves) {
      motion.cameras.push_back({scene.cameras.size() - 1, i});
    }
    if (const auto found = source.extensions.find("KHR_lights_punctual");
        found != source.extensions.end()) {
      reader.light(node.index, source, found->second.Get("light").GetNumberAsInt(),
                   posed.unmirrored(i));
      if (node.moves) motion.lights.push_back({scene.lights.size() - 1, i});
    }
  }
  reader.finish();
}

static_assert(std::endian::native == std::endian::little,
              "glTF buffers are little-endian and read in place");

GltfAccessor::GltfAccessor(const GltfDocument& document, int index)
    : document_(&document),
      accessor_(&entry(document.model.accessors, index)),
      place_(fmt::format("/accessors/{}", index)),
      components_(tinygltf::GetNumComponentsInType(static_cast<unsigned>(accessor_->type))),
      component_bytes_(bytes_of(accessor_->componentType)),
      element_bytes_(component_bytes_ * static_cast<unsigned>(components_)) {
  if (accessor_->bufferView >= 0) {
    stride_ = entry(document.model.bufferViews, accessor_->bufferView).byteStride;
    if (stride_ == 0) stride_ = element_bytes_;
    values_ =
        elements(accessor_->bufferView, accessor_->byteOffset, count(), stride_, element_bytes_);
  }
  if (const auto& sparse = accessor_->sparse; sparse.isSparse) {
    sparse_count_ = static_cast<std::size_t>(sparse.count);
    const std::size_t bytes = bytes_of(sparse.indices.componentType);
    sparse_indices_ =
        elements(sparse.indices.bufferView, static_cast<unsigned>(sparse.indices.byteOffset),
                 sparse_count_, bytes, bytes);
    sparse_values_ =
        elements(sparse.values.bufferView, static_cast<unsigned>(sparse.values.byteOffset),
                 sparse_count_, element_bytes_, element_bytes_);
  }
}

GltfAccessor::GltfAccessor(const GltfDocument& document, int index, std::string place,
                           std::initializer_list<int> types, const ComponentTypes& numbers,
                           std::optional<std::size_t> count)
    : GltfAccessor(document, index) {
  place_ = std::move(place);
  const bool fits = std::ranges::find(types, accessor_->type) != types.end() &&
                    numbers.include(accessor_->componentType, accessor_->normalized);
  if (fits && accessor_->count == count.value_or(accessor_->count)) return;
  std::vector<std::string> names;
  for (const int type : types) names.push_back(type_name(type));
  reject(document.file, place_,
         fmt::format("/accessors/{}, {} of {}, componentType {}{}", index, accessor_->count,
                     type_name(accessor_->type), accessor_->componentType,
                     accessor_->normalized ? ", normalized" : ""),
         fmt::format("{}{} of {}", count ? fmt::format("{} of ", *count) : "",
                     fmt::join(names, " or "), numbers.description));
}

/// Bytes of `count` elements of `bytes` each, with `stride`, from `offset`. Products fit 64 bits,
/// as counts are below 2^32.
std::span<const std::uint8_t> GltfAccessor::elements(int view, std::size_t offset,
                                                     std::size_t count, std::size_t stride,
                                                     std::size_t bytes) const {
  const auto view_bytes = document_->view(view);
  if (stride < bytes) {
    reject(document_->file, place_, fmt::format("elements of {} bytes", bytes),
           fmt::format("at most the byteStride {} of /bufferViews/{}", stride, view));
  }
  const std::size_t end = offset + (count - 1) * stride + bytes;
  if (end > view_bytes.size()) {
    reject(document_->file, place_, fmt::format("{} elements up to byte {}", count, end),
           fmt::format("at most the {} bytes of /bufferViews/{}", view_bytes.size(), view));
  }
  return view_bytes.subspan(offset, end - offset);
}

std::uint32_t GltfAccessor::sparse_index(std::size_t i) const {
  const int type = accessor_->sparse.indices.componentType;
  return load_unsigned(&sparse_indices_[i * bytes_of(type)], type);
}

const std::uint8_t* GltfAccessor::address(std::size_t element, int component) const {
  const std::size_t within = component_bytes_ * static_cast<unsigned>(component);
  if (sparse_count_ > 0) {
    std::size_t i = 0;  // first sparse index that is not below `element`, by bisection
    for (std::size_t end = sparse_count_; i < end;) {
      const std::size_t middle = i + (end - i) / 2;
      if (sparse_index(middle) < element)
        i = middle + 1;
      else
        end = middle;
    }
    if (i < sparse_count_ && sparse_index(i) == element)
      return &sparse_values_[i * element_bytes_ + within];
  }
  return values_.empty() ? nullptr : &values_[element * stride_ + within];
}

double GltfAccessor::number(std::size_t element, int component) const {
  const std::uint8_t* from = address(element, component);
  return from == nullptr ? 0.0 : load_number(from, accessor_->componentType, accessor_->normalized);
}

void GltfAccessor::reject_element(std::size_t element, const std::string& found,
                                  const std::string& allowed) const {
  reject(document_->file, place_, fmt::format("{} of element {}", found, element), allowed);
}

std::uint32_t GltfAccessor::index(std::size_t element, int component) const {
  const std::uint8_t* from = address(element, component);
  return from == nullptr ? 0 : load_unsigned(from, accessor_->componentType);
}

void check_accessors(const GltfDocument& document) {
  std::uint64_t total = 0;
  for (std::size_t a = 0; a < document.model.accessors.size(); ++a) {
    const GltfAccessor accessor(document, static_cast<int>(a));
    total += accessor.sparse_count_;
    if (total > bounds::kSparseElements) {
      reject(document.file, accessor.place_, fmt::format("{} sparse elements so far", total),
             fmt::format("at most {} in all", bounds::kSparseElements));
    }
    for (std::size_t i = 0; i < accessor.sparse_count_; ++i) {
      const std::uint32_t element = accessor.sparse_index(i);
      if (element >= accessor.count() || (i > 0 && element <= accessor.sparse_index(i - 1))) {
        reject(document.file, accessor.place_ + "/sparse/indices",
               fmt::format("index {} at {}", element, i),
               fmt::format("ascending indices below {}", accessor.count()));
      }
    }
  }
}

}  // namespace clpv
