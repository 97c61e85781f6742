// SPDX-License-Identifier: MIT
// Reads the attributes, triangles, joints and morph targets of a mesh primitive.
#include <algorithm>
#include <optional>

#include "scene/bounds.hpp"
#include "scene/gltf_accessor.hpp"
#include "scene/gltf_parts.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr glm::dvec3 kUp{0, 1, 0};   // normal of vertices that only degenerate triangles use
constexpr double kMinNormal = 1e-6;  // shorter stored normals count as missing
constexpr double kMaxWeight = 1e6;   // of a joint, before weights are normalised to a sum of 1

/// Accessors of a primitive's attributes, with equal counts.
struct Attributes {
  GltfAccessor position;
  std::optional<GltfAccessor> normal, uv, colour, indices;
  std::uint64_t corners() const { return indices ? indices->count() : position.count(); }
};

glm::dvec3 vector_in(const GltfAccessor& from, std::uint32_t index) {
  return {from.finite(index, 0), from.finite(index, 1), from.finite(index, 2)};
}

/// Corners of triangle `i`, counter-clockwise seen from its front (glTF 2.0, section 3.7.2.1).
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

class PrimitiveReader {
 public:
  PrimitiveReader(const GltfDocument& document, const tinygltf::Primitive& source, std::string place,
                  const UvMapping& mapping)
      : document_(document), source_(source), place_(std::move(place)), mapping_(mapping) {}

  Attributes attributes(bool textured, Notes& notes) const {
    const auto find = [&](const std::string& name, Types types, std::optional<std::size_t> count) {
      return attribute(source_.attributes, "/attributes", name, types, count);
    };
    const auto position = find("POSITION", {TINYGLTF_TYPE_VEC3}, std::nullopt);
    if (!position) reject_here("no attribute POSITION", "POSITION, a VEC3");
    const std::size_t count = position->count();
    Attributes made{*position, find("NORMAL", {TINYGLTF_TYPE_VEC3}, count), std::nullopt,
                    find("COLOR_0", {TINYGLTF_TYPE_VEC3, TINYGLTF_TYPE_VEC4}, count), std::nullopt};
    if (source_.indices >= 0) {
      made.indices =
          GltfAccessor(document_, source_.indices, place_ + "/indices", {TINYGLTF_TYPE_SCALAR}, kIndices);
    }
    if (textured) {
      const std::string set = fmt::format("TEXCOORD_{}", mapping_.set);
      made.uv = find(set, {TINYGLTF_TYPE_VEC2}, count);
      if (!made.uv) notes.add(fmt::format("{}: no {} for its material: uses 0, 0", place_, set));
    }
    return made;
  }

  /// Number of triangles; `mode` must have triangles. Rejects invalid numbers of corners and geometry beyond the budget.
  std::uint64_t triangle_count(const Attributes& from, int mode, const GeometryBudget& budget) const {
    const std::uint64_t corners = from.corners();
    const bool list = mode == TINYGLTF_MODE_TRIANGLES;
    if (corners < 3 || (list && corners % 3 != 0)) {
      reject_here(fmt::format("{} corners", corners), list ? "a multiple of 3, at least 3" : "at least 3");
    }
    const std::uint64_t triangles = list ? corners / 3 : corners - 2;
    if (triangles > budget.triangles) {
      reject_here(fmt::format("{} more triangles", triangles),
                  fmt::format("{} left of {} in all", budget.triangles, bounds::kTriangles));
    }
    const std::uint64_t stored = from.position.count(), split = from.normal ? 0 : 3 * triangles;
    if (stored > bounds::kVertices || split > budget.vertices) {
      reject_here(fmt::format("{} vertices", std::max(stored, split)),
                  fmt::format("{} left of {} in all", budget.vertices, bounds::kVertices));
    }
    return triangles;
  }

  void read_triangles(const Attributes& from, int mode, std::uint64_t count,
                      std::vector<std::uint32_t>& slots, LocalPrimitive& to) const {
    const std::size_t stored = from.position.count();
    if (slots.size() < stored) slots.resize(stored, kNoSlot);
    to.vertices.reserve(std::min<std::uint64_t>(stored, 3 * count));
    to.triangles.reserve(count);
    for (std::uint32_t i = 0; i < count; ++i) {
      const glm::uvec3 corner = corners_of(mode, i);
      glm::uvec3 triangle;
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t source = from.indices ? from.indices->index(corner[k]) : corner[k];
        if (source >= stored) {
          reject_here(fmt::format("index {} at {}", source, corner[k]), fmt::format("0 to {}", stored - 1));
        }
        if (slots[source] == kNoSlot) {
          slots[source] = static_cast<std::uint32_t>(to.vertices.size());
          to.vertices.push_back(vertex(from, source));
        }
        triangle[k] = slots[source];
      }
      to.triangles.push_back(triangle);
    }
    for (const LocalVertex& vertex : to.vertices) slots[vertex.source] = kNoSlot;
  }

  /// Reads joints and normalised weights of the vertices.
  void read_influences(const Attributes& from, LocalPrimitive& to) const {
    const auto find = [&](const char* name, const ComponentTypes& numbers) {
      return attribute(source_.attributes, "/attributes", name, {TINYGLTF_TYPE_VEC4}, from.position.count(),
                       numbers);
    };
    const auto joints = find("JOINTS_0", kJoints), weights = find("WEIGHTS_0", kNumbers);
    if (joints.has_value() != weights.has_value()) {
      reject(document_.file, place_ + "/attributes",
             joints ? "JOINTS_0 without WEIGHTS_0" : "WEIGHTS_0 without JOINTS_0", "both or none");
    }
    if (!joints) return;
    to.influences.reserve(to.vertices.size());
    for (const LocalVertex& vertex : to.vertices) {
      Influence made{};
      double sum = 0;
      for (int i = 0; i < 4; ++i) {
        const double weight = weights->number(vertex.source, i);
        if (!(weight >= 0 && weight <= kMaxWeight)) {
          reject(document_.file, place_ + "/attributes/WEIGHTS_0",
                 fmt::format("{} in component {} of vertex {}", weight, i, vertex.source),
                 fmt::format("0 to {}", kMaxWeight));
        }
        made.joints[i] = static_cast<std::uint16_t>(joints->index(vertex.source, i));
        made.weights[i] = weight;
        sum += weight;
      }
      for (double& weight : made.weights) weight = sum > 0 ? weight / sum : 0;
      if (sum == 0) made.weights[0] = 1;
      to.influences.push_back(made);
    }
  }

  void read_targets(const Attributes& from, GeometryBudget& budget, LocalPrimitive& to) const {
    for (std::size_t t = 0; t < source_.targets.size(); ++t) {
      const std::string place = fmt::format("/targets/{}", t);
      const auto read = [&](const char* name) {
        std::vector<glm::vec3> made;
        const auto found =
            attribute(source_.targets[t], place, name, {TINYGLTF_TYPE_VEC3}, from.position.count());
        if (!found) return made;
        const std::uint64_t numbers = 3 * to.vertices.size();
        if (numbers > budget.morph_numbers) {
          reject(document_.file, place_ + place, fmt::format("{} more numbers of morph targets", numbers),
                 fmt::format("{} left of {} in all", budget.morph_numbers, bounds::kMorphNumbers));
        }
        budget.morph_numbers -= numbers;
        made.reserve(to.vertices.size());
        for (const LocalVertex& vertex : to.vertices) made.emplace_back(vector_in(*found, vertex.source));
        return made;
      };
      MorphTarget target{read("POSITION"), {}};
      if (!to.flat) target.normals = read("NORMAL");
      to.targets.push_back(std::move(target));
    }
  }

 private:
  using Types = std::initializer_list<int>;

  std::optional<GltfAccessor> attribute(const std::map<std::string, int>& attributes,
                                        const std::string& place, const std::string& name, Types types,
                                        std::optional<std::size_t> count,
                                        const ComponentTypes& numbers = kNumbers) const {
    const auto found = attributes.find(name);
    if (found == attributes.end()) return std::nullopt;
    return GltfAccessor(document_, found->second, fmt::format("{}{}/{}", place_, place, name), types, numbers,
                        count);
  }

  LocalVertex vertex(const Attributes& from, std::uint32_t index) const {
    LocalVertex made{vector_in(from.position, index), {}, {}, glm::vec4(1), index};
    if (from.normal) made.normal = vector_in(*from.normal, index);
    if (from.uv) {
      made.uv =
          glm::vec2(mapping_.transform * glm::dvec3(from.uv->finite(index, 0), from.uv->finite(index, 1), 1));
      if (!std::isfinite(made.uv.x) || !std::isfinite(made.uv.y)) {
        reject_here(fmt::format("vertex {} at texture coordinates ({}, {})", index, made.uv.x, made.uv.y),
                    "finite numbers");
      }
    }
    for (int i = 0; from.colour && i < from.colour->components(); ++i)
      made.colour[i] = static_cast<float>(std::clamp(from.colour->finite(index, i), 0.0, 1.0));
    return made;
  }

  [[noreturn]] void reject_here(const std::string& found, const std::string& allowed) const {
    reject(document_.file, place_, found, allowed);
  }

  const GltfDocument& document_;
  const tinygltf::Primitive& source_;
  std::string place_;
  const UvMapping& mapping_;
};

/// Gives each triangle three vertices with the triangle's normal (flat normals: glTF 2.0, section 3.7.2.1).
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

/// Normalises stored normals; missing ones become the mean of their triangles' normals.
void normalize_stored(LocalPrimitive& primitive) {
  std::vector<bool> missing(primitive.vertices.size(), false);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    glm::dvec3& normal = primitive.vertices[i].normal;
    missing[i] = glm::length(normal) < kMinNormal;
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
    if (missing[i]) normal = glm::length(normal) < kMinNormal ? kUp : glm::normalize(normal);
  }
}

}  // namespace

LocalPrimitive read_primitive(const GltfDocument& document, int mesh, std::size_t index,
                              const MaterialSet& materials, GeometryBudget& budget,
                              std::vector<std::uint32_t>& slots, Notes& notes) {
  const tinygltf::Primitive& source = entry(document.model.meshes, mesh).primitives[index];
  LocalPrimitive made;
  made.place = fmt::format("/meshes/{}/primitives/{}", mesh, index);
  if (source.mode < TINYGLTF_MODE_TRIANGLES) {
    notes.add(fmt::format("{}: made of {}, which are not drawn", made.place,
                          source.mode == TINYGLTF_MODE_POINTS ? "points" : "lines"));
    return made;
  }
  made.material = static_cast<std::uint32_t>(
      source.material < 0 ? static_cast<int>(materials.materials.size()) - 1 : source.material);
  const ClpvMaterial& material = materials.materials[made.material];
  const bool textured = material.texture != CLPV_NO_TEXTURE || material.emissive_texture != CLPV_NO_TEXTURE;
  const PrimitiveReader reader(document, source, made.place, materials.mappings[made.material]);
  const Attributes attributes = reader.attributes(textured, notes);
  const std::uint64_t triangles = reader.triangle_count(attributes, source.mode, budget);
  reader.read_triangles(attributes, source.mode, triangles, slots, made);
  made.flat = !attributes.normal;
  if (made.flat) {
    split_flat(made);
  } else {
    normalize_stored(made);
  }
  reader.read_influences(attributes, made);
  reader.read_targets(attributes, budget, made);
  if (source.attributes.contains("JOINTS_1"))
    notes.add(fmt::format("{}: more than four joints per vertex: only JOINTS_0 is read", made.place));
  return made;
}

}  // namespace clpv
