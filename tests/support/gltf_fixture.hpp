// SPDX-License-Identifier: MIT
// The common ground of tests that load a small glTF model: a folder, a builder, and what to look at.
#pragma once

#include "tests/support/gltf_builder.hpp"
#include "tests/support/tiny_images.hpp"

namespace clpv::test {

inline constexpr float kClose = 1e-6f;

inline const glm::vec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

inline std::vector<glm::vec3> corners(const Scene& scene, std::size_t triangle) {
  return {position(scene, triangle, 0), position(scene, triangle, 1), position(scene, triangle, 2)};
}

inline glm::vec2 uv(const Scene& scene, std::size_t vertex) {
  return {scene.vertices[vertex].uv[0], scene.vertices[vertex].uv[1]};
}

/// A file of its own, and the scene made of it.
struct GltfTest : ::testing::Test {
  TemporaryFolder folder;
  GltfBuilder model;

  Scene load() { return load_scene(model.write(folder)); }

  /// A material with that texture image; returns the material.
  json& textured(std::string_view image_base64, const std::string& name = "image.png") {
    folder.write(name, decode_base64(image_base64));
    const int image = model.add("images", {{"uri", name}});
    const int texture = model.add("textures", {{"source", image}});
    model.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    return model.document["materials"].back();
  }

  /// A textured triangle with texture coordinates (0,0), (1,0), (0,1).
  json& textured_triangle() {
    const int position = model.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int uv = model.accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
    return model.mesh({{"POSITION", position}, {"TEXCOORD_0", uv}}, {{"material", 0}});
  }
};

}  // namespace clpv::test
