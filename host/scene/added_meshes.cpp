// SPDX-License-Identifier: MIT
#include "scene/added_meshes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "image/tone_map.hpp"
#include "scene/bounds.hpp"
#include "scene/primitive.hpp"
#include "support/error.hpp"

namespace clpv {
namespace {

constexpr const char* kAdd = "add_mesh";

/// A caller's array of vectors; messages name it and the entry.
template <typename T, std::size_t n>
class MemoryArray : public NumberArray {
 public:
  MemoryArray(const char* function, const char* name, std::span<const std::array<T, n>> values)
      : function_(function), name_(name), values_(values) {}

  std::size_t count() const override { return values_.size(); }
  int components() const override { return static_cast<int>(n); }
  double number(std::size_t element, int component) const override {
    return values_[element][component];
  }
  std::uint32_t index(std::size_t element, int component) const override {
    return static_cast<std::uint32_t>(values_[element][component]);
  }
  [[noreturn]] void reject_element(std::size_t element, const std::string& found,
                                   const std::string& allowed) const override {
    reject(function_, fmt::format("{}[{}]", name_, element), found, allowed);
  }

 private:
  const char *function_, *name_;
  std::span<const std::array<T, n>> values_;
};

using Vectors = MemoryArray<float, 3>;

/// The corners of triangles, one by one.
class Corners : public NumberArray {
 public:
  explicit Corners(std::span<const std::array<std::uint32_t, 3>> triangles)
      : triangles_(triangles) {}

  std::size_t count() const override { return 3 * triangles_.size(); }
  int components() const override { return 1; }
  double number(std::size_t element, int component) const override {
    return index(element, component);
  }
  std::uint32_t index(std::size_t element, int) const override {
    return triangles_[element / 3][element % 3];
  }
  [[noreturn]] void reject_element(std::size_t element, const std::string& found,
                                   const std::string& allowed) const override {
    reject(kAdd, fmt::format("triangles[{}]", element / 3), found, allowed);
  }

 private:
  std::span<const std::array<std::uint32_t, 3>> triangles_;
};

void check_length(const char* function, const char* name, std::size_t found, std::size_t allowed) {
  if (found == allowed) return;
  reject(function, name, fmt::format("{} elements", found),
         fmt::format("{}, one for each vertex", allowed));
}

LocalPrimitive primitive_of(const Mesh& mesh, const SceneData& scene) {
  const MemoryArray<float, 2> uvs(kAdd, "uvs", mesh.uvs);
  const MemoryArray<float, 4> colours(kAdd, "colours", mesh.colours);
  const Vectors positions(kAdd, "positions", mesh.positions),
      normals(kAdd, "normals", mesh.normals);
  const Corners corners(mesh.triangles);
  const auto given = [&](const NumberArray& array, const char* name) {
    if (array.count() > 0) check_length(kAdd, name, array.count(), mesh.positions.size());
    return array.count() > 0 ? &array : nullptr;
  };
  if (mesh.material.texture && mesh.uvs.empty() && !mesh.positions.empty())
    reject(kAdd, "uvs", "none beside a texture", "one for each vertex");
  PrimitiveArrays arrays{&positions, given(normals, "normals"), given(uvs, "uvs"),
                         given(colours, "colours"), &corners};
  arrays.smooth = mesh.smooth;
  const GeometryBudget budget{bounds::kVertices - scene.vertices.size(),
                              bounds::kTriangles - scene.triangles.size(), 0};
  std::vector<std::uint32_t> slots;
  return make_primitive(arrays, kAdd, "triangles", 0, budget, slots);
}

/// A tree of one node. Rejects transforms that are not affine or not finite.
NodeTree tree_of(const char* function, const Transform& transform) {
  TreeNode node;
  node.index = -1;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      const double value = transform[row][column];
      if (!std::isfinite(value))
        reject(function, fmt::format("transform[{}][{}]", row, column), fmt::format("{}", value),
               "finite numbers");
      node.rest[column][row] = value;
    }
  }
  if (transform[3] != kIdentity[3]) {
    const auto& last = transform[3];
    reject(function, "transform[3]",
           fmt::format("{}, {}, {}, {}", last[0], last[1], last[2], last[3]), "0, 0, 0, 1");
  }
  NodeTree tree;
  tree.file = function;
  tree.nodes.push_back(node);
  return tree;
}

void check_range(const std::string& place, double value, double maximum) {
  if (!(value >= 0 && value <= maximum))  // rejects NaN too
    reject(kAdd, place, fmt::format("{}", value), fmt::format("0 to {}", maximum));
}

/// Material without its texture.
ClpvMaterial checked(const Material& given) {
  ClpvMaterial made = blank_material();
  for (int i = 0; i < 4; ++i) {
    check_range(fmt::format("material: base_colour[{}]", i), given.base_colour[i], 1);
    made.base_colour[i] = static_cast<float>(given.base_colour[i]);
  }
  for (int i = 0; i < 3; ++i) {
    check_range(fmt::format("material: emission[{}]", i), given.emission[i], bounds::kEmission);
    made.emissive[i] = static_cast<float>(given.emission[i]);
  }
  if (given.alpha_cutoff) {
    check_range("material: alpha_cutoff", *given.alpha_cutoff, 1);
    made.flags |= CLPV_MATERIAL_MASKED;
    made.alpha_cutoff = static_cast<float>(*given.alpha_cutoff);
  }
  if (given.double_sided) made.flags |= CLPV_MATERIAL_DOUBLE_SIDED;
  return made;
}

void check_texture(const Material::Texture& given, const SceneData& scene) {
  constexpr const char* kPlace = "material: texture";
  if (given.width < 1 || given.height < 1 || given.width > bounds::kImageSide ||
      given.height > bounds::kImageSide) {
    reject(kAdd, kPlace, fmt::format("{} x {} pixels", given.width, given.height),
           fmt::format("1 to {} pixels per side", bounds::kImageSide));
  }
  const std::uint64_t bytes = 4ull * given.width * given.height;
  if (given.rgba.size() != bytes) {
    reject(kAdd, kPlace,
           fmt::format("{} bytes for {} x {} pixels", given.rgba.size(), given.width, given.height),
           fmt::format("{}", bytes));
  }
  std::uint64_t total = bytes;
  for (const Texture& texture : scene.textures) total += texture.rgba.size();
  if (total > bounds::kTexelBytes) {
    reject(kAdd, kPlace, fmt::format("{} bytes of texels so far", total),
           fmt::format("at most {} in all", bounds::kTexelBytes));
  }
}

bool same(const ClpvMaterial& a, const ClpvMaterial& b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

}  // namespace

AddedMeshes::Added& AddedMeshes::entry(const char* function, int mesh) {
  const auto found = meshes_.find(mesh);
  if (found == meshes_.end())
    throw Error(ExitCode::usage, "{}: mesh: found {}, allowed: a number that add_mesh returned",
                function, mesh);
  return found->second;
}

int AddedMeshes::append(Added added, SceneData& scene) {
  reserve(scene, *added.instance.primitive, 1, kAdd);
  const std::size_t vertices = scene.vertices.size(), triangles = scene.triangles.size();
  try {
    PosedTree posed(added.tree, 0);
    clpv::append(added.instance, posed, scene);
  } catch (...) {
    scene.vertices.resize(vertices);
    scene.triangles.resize(triangles);
    throw;
  }
  if (added.moves) scene.moving.push_back(range_of(added.instance));
  meshes_.emplace(next_, std::move(added));
  return next_++;
}

int AddedMeshes::add(const Mesh& mesh, const Transform& transform, SceneData& scene) {
  if (!file_) file_ = FileParts{scene.materials.size(), scene.textures.size(), scene.moving.size()};
  Added added{{}, tree_of(kAdd, transform), mesh.positions.size()};
  LocalPrimitive primitive = primitive_of(mesh, scene);
  primitive.material = material_slot(mesh.material, scene);
  added.instance.primitive = std::make_shared<const LocalPrimitive>(std::move(primitive));
  added.moves = mesh.moves;
  return append(std::move(added), scene);
}

int AddedMeshes::add_instance(int mesh, const Transform& transform, SceneData& scene) {
  constexpr const char* kFunction = "add_instance";
  const Added& like = entry(kFunction, mesh);
  Added added{{}, tree_of(kFunction, transform), like.positions};
  added.instance.primitive = like.instance.primitive;
  added.moves = like.moves;
  return append(std::move(added), scene);
}

void AddedMeshes::remove(int mesh, SceneData& scene) {
  const Instance& removed = entry("remove_mesh", mesh).instance;
  scene.vertices.resize(removed.first_vertex);
  scene.triangles.resize(removed.first_triangle);
  for (auto later = meshes_.erase(meshes_.find(mesh)); later != meshes_.end(); ++later) {
    PosedTree posed(later->second.tree, 0);
    clpv::append(later->second.instance, posed, scene);
  }
  for (std::size_t i = file_->textures; i < scene.textures.size(); ++i) {
    if (!uses_texture(i, scene))
      scene.textures[i] = {1, 1, CLPV_WRAP_REPEAT, CLPV_WRAP_REPEAT, {255, 255, 255, 255}, {}};
  }
  list_moving(scene);
}

bool AddedMeshes::set_positions(int mesh, std::span<const std::array<float, 3>> given,
                                std::span<const std::array<float, 3>> given_normals,
                                SceneData& scene) {
  constexpr const char* kFunction = "set_positions";
  const Added& one = entry(kFunction, mesh);
  const std::shared_ptr<const LocalPrimitive> before = one.instance.primitive;
  const Vectors positions(kFunction, "positions", given),
      normals(kFunction, "normals", given_normals);
  check_length(kFunction, "positions", given.size(), one.positions);
  if (!given_normals.empty()) {
    if (before->normals != Normals::stored)
      reject(kFunction, "normals", "an array", "none, since the mesh was added without normals");
    check_length(kFunction, "normals", given_normals.size(), one.positions);
  }
  LocalPrimitive moved = *before;
  move_vertices(moved, positions, given_normals.empty() ? nullptr : &normals);
  const auto after = std::make_shared<const LocalPrimitive>(std::move(moved));
  const auto place_all = [&](const auto& from, const auto& to) {
    for (auto& [number, added] : meshes_) {
      if (added.instance.primitive != from) continue;
      added.instance.primitive = to;
      added.tree.file = kFunction;
      PosedTree posed(added.tree, 0);
      place(added.instance, posed, scene);
    }
  };
  try {
    place_all(before, after);
  } catch (...) {
    place_all(after, before);
    throw;
  }
  bool first = false;
  for (auto& [number, added] : meshes_) {
    if (added.instance.primitive == after && !added.moves) first = added.moves = true;
  }
  if (first) list_moving(scene);
  return first;
}

bool AddedMeshes::set_transform(int mesh, const Transform& transform, SceneData& scene) {
  constexpr const char* kFunction = "set_transform";
  Added& added = entry(kFunction, mesh);
  NodeTree moved = tree_of(kFunction, transform);
  std::swap(added.tree, moved);
  const auto place_it = [&] {
    PosedTree posed(added.tree, 0);
    place(added.instance, posed, scene);
  };
  try {
    place_it();
  } catch (...) {
    std::swap(added.tree, moved);
    place_it();
    throw;
  }
  if (added.moves) return false;
  added.moves = true;
  list_moving(scene);
  return true;
}

void AddedMeshes::list_moving(SceneData& scene) const {
  scene.moving.resize(file_->moving);
  for (const auto& [number, added] : meshes_) {
    if (added.moves) scene.moving.push_back(range_of(added.instance));
  }
}

bool AddedMeshes::uses_material(std::size_t slot) const {
  return std::ranges::any_of(
      meshes_, [&](const auto& each) { return each.second.instance.primitive->material == slot; });
}

bool AddedMeshes::uses_texture(std::size_t slot, const SceneData& scene) const {
  return std::ranges::any_of(meshes_, [&](const auto& each) {
    return scene.materials[each.second.instance.primitive->material].texture == slot;
  });
}

/// Place of an equal texture or material, else of one that no mesh uses, else a new one.
std::uint32_t AddedMeshes::texture_slot(const Material::Texture& given, SceneData& scene) const {
  check_texture(given, scene);
  std::size_t slot = file_->textures;
  while (slot < scene.textures.size() &&
         !(scene.textures[slot].width == given.width && scene.textures[slot].rgba == given.rgba))
    ++slot;
  if (slot == scene.textures.size()) {
    slot = file_->textures;
    while (slot < scene.textures.size() && uses_texture(slot, scene)) ++slot;
    if (slot == bounds::kTextures)
      reject(kAdd, "material: texture", "one more texture",
             fmt::format("at most {}", bounds::kTextures));
    if (slot == scene.textures.size()) scene.textures.emplace_back();
    scene.textures[slot] = {given.width,      given.height, CLPV_WRAP_REPEAT,
                            CLPV_WRAP_REPEAT, given.rgba,   "of a mesh"};
  }
  return static_cast<std::uint32_t>(slot);
}

std::uint32_t AddedMeshes::material_slot(const Material& given, SceneData& scene) const {
  ClpvMaterial made = checked(given);
  if (given.texture) made.texture = texture_slot(*given.texture, scene);
  std::size_t slot = file_->materials;
  while (slot < scene.materials.size() && !same(scene.materials[slot], made)) ++slot;
  if (slot == scene.materials.size()) {
    slot = file_->materials;
    while (slot < scene.materials.size() && uses_material(slot)) ++slot;
    if (slot == bounds::kMaterials)
      reject(kAdd, "material", "one more material", fmt::format("at most {}", bounds::kMaterials));
    if (slot == scene.materials.size()) scene.materials.emplace_back();
    scene.materials[slot] = made;
  }
  return static_cast<std::uint32_t>(slot);
}

Material::Texture Material::Texture::of(const Image& image) {
  check_image("texture", image);
  const auto r = image.channel("R"), g = image.channel("G"), b = image.channel("B"),
             a = image.channel("A");
  if (!r || !g || !b) reject("texture", "channels", "others", "R, G, B and optionally A");
  const auto byte = [](float value) {
    return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255 + 0.5f);
  };
  Texture made{
      static_cast<std::uint32_t>(image.width), static_cast<std::uint32_t>(image.height), {}};
  for (std::size_t p = 0; p < image.pixel_count(); ++p) {
    const float* in = &image.pixels[p * image.channels.size()];
    for (const auto c : {r, g, b, a}) {
      const float value = c ? in[*c] : 1;
      if (!(value >= 0 && value <= 1)) {  // rejects NaN too
        reject("texture", fmt::format("[{}, {}]", p / image.width, p % image.width),
               fmt::format("{}", value), "0 to 1");
      }
      const bool encode = c != a && image.encoding == Encoding::linear;
      made.rgba.push_back(byte(encode ? srgb_encode(value) : value));
    }
  }
  return made;
}

}  // namespace clpv
