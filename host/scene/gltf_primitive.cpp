// SPDX-License-Identifier: MIT
#include "scene/gltf_primitive.hpp"

#include <algorithm>
#include <optional>

#include "scene/bounds.hpp"
#include "scene/gltf_accessor.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr glm::dvec3 kUp{0, 1, 0};        // the normal of vertices that only degenerate triangles use
constexpr double kShortestStored = 1e-6;  // a shorter stored normal is none

/// A primitive's attributes, checked against each other.
struct Attributes {
  GltfAccessor position;
  std::optional<GltfAccessor> normal, uv, colour, indices;
  std::uint64_t corners() const { return indices ? indices->count() : position.count(); }
};

class PrimitiveReader {
 public:
  PrimitiveReader(const GltfDocument& document, const tinygltf::Primitive& source, std::string place,
                  const UvMapping& mapping)
      : document_(document), source_(source), place_(std::move(place)), mapping_(mapping) {}

  Attributes attributes(bool textured, Notes& notes) const;
  /// Of a mode that has triangles. Refuses what the mode or the room left does not allow.
  std::uint64_t triangle_count(const Attributes& from, int mode, const Room& room) const;
  void read_triangles(const Attributes& from, int mode, std::uint64_t count, VertexMap& map,
                      LocalPrimitive& to) const;

 private:
  std::optional<GltfAccessor> attribute(const std::string& name, int least_components, int most_components,
                                        std::size_t count) const;
  std::optional<GltfAccessor> indices() const;
  double component(const GltfAccessor& from, const char* name, std::uint32_t index, int i) const;
  LocalVertex vertex(const Attributes& from, std::uint32_t index) const;
  [[noreturn]] void refuse_here(const std::string& found, const std::string& allowed) const {
    refuse(document_.file, place_, found, allowed);
  }

  const GltfDocument& document_;
  const tinygltf::Primitive& source_;
  std::string place_;
  const UvMapping& mapping_;
};

std::optional<GltfAccessor> PrimitiveReader::attribute(const std::string& name, int least_components,
                                                       int most_components, std::size_t count) const {
  const auto found = source_.attributes.find(name);
  if (found == source_.attributes.end()) return std::nullopt;
  GltfAccessor accessor(document_, found->second);
  const std::string place = fmt::format("{}/attributes/{}", place_, name);
  if (accessor.components() < least_components || accessor.components() > most_components ||
      document_.model.accessors[static_cast<std::size_t>(found->second)].type > TINYGLTF_TYPE_VEC4) {
    refuse(document_.file, place, fmt::format("elements of {} components", accessor.components()),
           fmt::format("VEC{}{}", least_components,
                       most_components > least_components ? fmt::format(" or VEC{}", most_components) : ""));
  }
  if (count != 0 && accessor.count() != count) {
    refuse(document_.file, place, fmt::format("{} elements", accessor.count()),
           fmt::format("as many as POSITION, {}", count));
  }
  return accessor;
}

Attributes PrimitiveReader::attributes(bool textured, Notes& notes) const {
  const auto position = attribute("POSITION", 3, 3, 0);
  if (!position) refuse_here("no attribute POSITION", "POSITION, a VEC3");
  const std::string set = fmt::format("TEXCOORD_{}", mapping_.set);
  Attributes made{*position, attribute("NORMAL", 3, 3, position->count()), std::nullopt,
                  attribute("COLOR_0", 3, 4, position->count()), indices()};
  if (textured) {
    made.uv = attribute(set, 2, 2, position->count());
    if (!made.uv)
      notes.add(fmt::format("{}: its material wants {}, which it lacks: 0, 0 instead", place_, set));
  }
  return made;
}

std::optional<GltfAccessor> PrimitiveReader::indices() const {
  if (source_.indices < 0) return std::nullopt;
  GltfAccessor accessor(document_, source_.indices);
  const int type = accessor.component_type();
  if (accessor.components() != 1 || accessor.normalized() ||
      (type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE && type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
       type != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)) {
    refuse(document_.file, accessor.place(), "indices that are no unsigned integer scalars",
           "SCALAR of componentType 5121, 5123 or 5125, not normalized");
  }
  return accessor;
}

double PrimitiveReader::component(const GltfAccessor& from, const char* name, std::uint32_t index,
                                  int i) const {
  const double value = from.number(index, i);
  if (!std::isfinite(value)) {
    refuse_here(fmt::format("{} in component {} of {} of vertex {}", value, i, name, index),
                "finite numbers");
  }
  return value;
}

LocalVertex PrimitiveReader::vertex(const Attributes& from, std::uint32_t index) const {
  LocalVertex made{{}, {}, {}, glm::vec4(1), index};
  for (int i = 0; i < 3; ++i) made.position[i] = component(from.position, "POSITION", index, i);
  for (int i = 0; i < 3 && from.normal; ++i) made.normal[i] = component(*from.normal, "NORMAL", index, i);
  if (from.uv) {
    const glm::dvec3 uv(component(*from.uv, "TEXCOORD", index, 0), component(*from.uv, "TEXCOORD", index, 1),
                        1);
    made.uv = glm::vec2(mapping_.transform * uv);
    if (!std::isfinite(made.uv.x) || !std::isfinite(made.uv.y)) {
      refuse_here(fmt::format("vertex {} at texture coordinates ({}, {})", index, made.uv.x, made.uv.y),
                  "finite numbers");
    }
  }
  for (int i = 0; from.colour && i < from.colour->components(); ++i) {
    made.colour[i] = static_cast<float>(std::clamp(component(*from.colour, "COLOR_0", index, i), 0.0, 1.0));
  }
  return made;
}

/// The corners of triangle `i`, in the order that makes its front counter-clockwise (glTF 2.0,
/// section 3.7.2.1).
glm::uvec3 corners_of(int mode, std::uint32_t i) {
  switch (mode) {
    case TINYGLTF_MODE_TRIANGLE_STRIP:
      return {i, i + 1 + i % 2, i + 2 - i % 2};
    case TINYGLTF_MODE_TRIANGLE_FAN:
      return {i + 1, i + 2, 0};
    default:
      return {3 * i, 3 * i + 1, 3 * i + 2};
  }
}

std::uint64_t PrimitiveReader::triangle_count(const Attributes& from, int mode, const Room& room) const {
  const std::uint64_t corners = from.corners();
  const bool list = mode == TINYGLTF_MODE_TRIANGLES;
  if (corners < 3 || (list && corners % 3 != 0)) {
    refuse_here(fmt::format("{} corners", corners), list ? "a multiple of 3, at least 3" : "at least 3");
  }
  const std::uint64_t triangles = list ? corners / 3 : corners - 2;
  if (triangles > room.triangles) {
    refuse_here(fmt::format("{} more triangles", triangles),
                fmt::format("{} left of {} in all", room.triangles, bounds::kTriangles));
  }
  const std::uint64_t stored = from.position.count(), split = from.normal ? 0 : 3 * triangles;
  if (stored > bounds::kVertices || split > room.vertices) {
    refuse_here(fmt::format("{} vertices", std::max(stored, split)),
                fmt::format("{} left of {} in all", room.vertices, bounds::kVertices));
  }
  return triangles;
}

void PrimitiveReader::read_triangles(const Attributes& from, int mode, std::uint64_t count, VertexMap& map,
                                     LocalPrimitive& to) const {
  const std::size_t stored = from.position.count();
  map.restart(stored);
  to.vertices.reserve(std::min<std::uint64_t>(stored, 3 * count));
  to.triangles.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::uvec3 corner = corners_of(mode, i);
    glm::uvec3 triangle;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t source = from.indices ? from.indices->index(corner[k]) : corner[k];
      if (source >= stored) {
        refuse_here(fmt::format("index {} at {}", source, corner[k]), fmt::format("0 to {}", stored - 1));
      }
      auto fresh = static_cast<std::uint32_t>(to.vertices.size());
      triangle[k] = map.slot(source, fresh);
      if (fresh > to.vertices.size()) to.vertices.push_back(vertex(from, source));
    }
    to.triangles.push_back(triangle);
  }
}

/// Each triangle gets three vertices of its own with its normal (glTF 2.0, section 3.7.2.1: flat normals).
void split_flat(LocalPrimitive& primitive) {
  std::vector<LocalVertex> split;
  split.reserve(primitive.triangles.size() * 3);
  for (glm::uvec3& triangle : primitive.triangles) {
    const glm::dvec3 normal = triangle_normal(primitive.vertices, triangle);
    for (int i = 0; i < 3; ++i) {
      split.push_back(primitive.vertices[triangle[i]]);
      split.back().normal = normal == glm::dvec3(0) ? kUp : normal;
      triangle[i] = static_cast<std::uint32_t>(split.size() - 1);
    }
  }
  primitive.vertices = std::move(split);
}

/// Stored normals become unit; those of no length take their triangle's.
void normalize_stored(LocalPrimitive& primitive) {
  std::vector<bool> missing(primitive.vertices.size(), false);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    glm::dvec3& normal = primitive.vertices[i].normal;
    missing[i] = glm::length(normal) < kShortestStored;
    normal = missing[i] ? glm::dvec3(0) : glm::normalize(normal);
  }
  if (std::find(missing.begin(), missing.end(), true) == missing.end()) return;
  for (const glm::uvec3& triangle : primitive.triangles) {
    for (int i = 0; i < 3; ++i) {
      if (missing[triangle[i]])
        primitive.vertices[triangle[i]].normal += triangle_normal(primitive.vertices, triangle);
    }
  }
  for (std::size_t i = 0; i < missing.size(); ++i) {
    glm::dvec3& normal = primitive.vertices[i].normal;
    if (missing[i]) normal = glm::length(normal) < kShortestStored ? kUp : glm::normalize(normal);
  }
}

}  // namespace

glm::dvec3 triangle_normal(const std::vector<LocalVertex>& vertices, const glm::uvec3& t) {
  const glm::dvec3& a = vertices[t.x].position;
  const glm::dvec3 n = glm::cross(vertices[t.y].position - a, vertices[t.z].position - a);
  const double length = glm::length(n);
  return length > 0 && std::isfinite(length) ? n / length : glm::dvec3(0);
}

void VertexMap::restart(std::size_t count) {
  if (entries_.size() < count) entries_.resize(count);
  if (++stamp_ == 0) {  // wrapped: old stamps would look new
    std::fill(entries_.begin(), entries_.end(), Entry{});
    stamp_ = 1;
  }
}

std::uint32_t VertexMap::slot(std::uint32_t source, std::uint32_t& fresh) {
  Entry& entry = entries_[source];
  if (entry.stamp != stamp_) entry = {stamp_, fresh++};
  return entry.slot;
}

LocalPrimitive read_primitive(const GltfDocument& document, std::size_t mesh, std::size_t index,
                              const MaterialSet& materials, const Room& room, VertexMap& map, Notes& notes) {
  const tinygltf::Primitive& source = document.model.meshes[mesh].primitives[index];
  LocalPrimitive made;
  made.place = fmt::format("/meshes/{}/primitives/{}", mesh, index);
  const int mode = source.mode < 0 ? TINYGLTF_MODE_TRIANGLES : source.mode;
  if (mode < TINYGLTF_MODE_TRIANGLES) {
    notes.add(fmt::format("{}: made of {}, which are not drawn", made.place,
                          mode == TINYGLTF_MODE_POINTS ? "points" : "lines"));
    return made;
  }
  made.material = static_cast<std::uint32_t>(
      source.material < 0 ? static_cast<int>(materials.materials.size()) - 1 : source.material);
  const Material& material = materials.materials[made.material];
  const bool textured = material.texture != CLPV_NO_TEXTURE || material.emissive_texture != CLPV_NO_TEXTURE;
  const PrimitiveReader reader(document, source, made.place, materials.mappings[made.material]);
  const Attributes attributes = reader.attributes(textured, notes);
  const std::uint64_t triangles = reader.triangle_count(attributes, mode, room);
  reader.read_triangles(attributes, mode, triangles, map, made);
  made.flat = !attributes.normal;
  if (made.flat) {
    split_flat(made);
  } else {
    normalize_stored(made);
  }
  return made;
}

}  // namespace clpv
