// SPDX-License-Identifier: MIT
// Small glTF files made in code, valid or not, in a temporary folder.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scene/bounds.hpp"
#include "scene/load.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/tiny_images.hpp"

namespace clpv::test {

using nlohmann::json;

/// Raw bytes of values in a row.
template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// A document and its one binary buffer. Fields of `document` may be changed at will before
/// writing.
struct GltfBuilder {
  json document = {{"asset", {{"version", "2.0"}}}};
  std::string binary;

  /// The index of what is appended to an array of the document.
  int add(const std::string& list, json value) {
    document[list].push_back(std::move(value));
    return static_cast<int>(document[list].size()) - 1;
  }

  int view(const std::string& bytes, int stride = 0) {
    binary.resize((binary.size() + 3) / 4 * 4);
    json made = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
    if (stride > 0) made["byteStride"] = stride;
    binary += bytes;
    return add("bufferViews", made);
  }

  static int component_type(float) { return 5126; }
  static int component_type(std::int8_t) { return 5120; }
  static int component_type(std::uint8_t) { return 5121; }
  static int component_type(std::int16_t) { return 5122; }
  static int component_type(std::uint16_t) { return 5123; }
  static int component_type(std::uint32_t) { return 5125; }
  static int components(const std::string& type) {
    return type == "SCALAR" ? 1 : type.back() - '0';
  }

  template <typename T>
  int accessor(const std::string& type, const std::vector<T>& values, bool normalized = false) {
    json made = {{"bufferView", view(bytes_of(values))},
                 {"componentType", component_type(T{})},
                 {"count", values.size() / static_cast<std::size_t>(components(type))},
                 {"type", type}};
    if (normalized) made["normalized"] = true;
    return add("accessors", made);
  }

  /// Replaces elements of an accessor, which has three floats each.
  void make_sparse(int accessor, const std::vector<std::uint16_t>& indices,
                   const std::vector<float>& values) {
    document["accessors"][static_cast<std::size_t>(accessor)]["sparse"] = {
        {"count", indices.size()},
        {"indices", {{"bufferView", view(bytes_of(indices))}, {"componentType", 5123}}},
        {"values", {{"bufferView", view(bytes_of(values))}}}};
  }

  /// A mesh of one primitive, on a new node. Returns the primitive, to be changed further.
  json& mesh(json attributes, json more = json::object()) {
    more["attributes"] = std::move(attributes);
    const int index = add("meshes", {{"primitives", json::array({more})}});
    add("nodes", {{"mesh", index}});
    return document["meshes"][static_cast<std::size_t>(index)]["primitives"][0];
  }

  /// The triangle (0,0,0), (1,0,0), (0,1,0), facing +z, without normals.
  json& triangle(json more = json::object()) {
    return mesh({{"POSITION", accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0})}},
                std::move(more));
  }

  /// A square at y = 0, facing up, of twice that edge round the origin, without normals.
  json& square(float half) {
    const int corners =
        accessor<float>("VEC3", {-half, 0, -half, -half, 0, half, half, 0, half, half, 0, -half});
    return mesh({{"POSITION", corners}},
                {{"indices", accessor<std::uint8_t>("SCALAR", {0, 1, 2, 0, 2, 3})}});
  }

  void finish(const std::string& uri) {
    if (binary.empty()) return;
    document["buffers"] = {{{"byteLength", binary.size()}}};
    if (!uri.empty()) document["buffers"][0]["uri"] = uri;
  }

  std::filesystem::path write(const TemporaryFolder& folder,
                              const std::string& name = "model.gltf") {
    finish("model.bin");
    folder.write("model.bin", binary);
    return folder.write(name, document.dump());
  }

  std::string glb() {
    finish("");
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string data = binary;
    data.resize((data.size() + 3) / 4 * 4);
    const auto word = [](std::size_t value) {
      return bytes_of<std::uint32_t>({static_cast<std::uint32_t>(value)});
    };
    std::string out = "glTF" + word(2) + word(12 + 8 + text.size() + 8 + data.size());
    return out + word(text.size()) + "JSON" + text + word(data.size()) + std::string("BIN\0", 4) +
           data;
  }
};

/// Loads invalid input and returns the error message.
inline std::string rejection(const std::filesystem::path& path) {
  return error_of(ExitCode::bad_input, [&] { load_scene(path); });
}

inline glm::vec3 position(const SceneData& scene, std::size_t triangle, int corner) {
  const float* p = scene.vertices[scene.triangles[triangle].vertex[corner]].position;
  return {p[0], p[1], p[2]};
}

inline glm::vec3 normal(const SceneData& scene, std::size_t triangle, int corner) {
  const float* n = scene.vertices[scene.triangles[triangle].vertex[corner]].normal;
  return {n[0], n[1], n[2]};
}

/// Unit, to the side from which the corners are counter-clockwise.
inline glm::vec3 face_normal(const SceneData& scene, std::size_t triangle) {
  const glm::vec3 a = position(scene, triangle, 0);
  return glm::normalize(
      glm::cross(position(scene, triangle, 1) - a, position(scene, triangle, 2) - a));
}

MATCHER_P2(IsNear, wanted, tolerance, "") {
  return glm::length(arg - wanted) <= tolerance;
}

inline constexpr float kClose = 1e-6f;

inline const glm::vec3 kX(1, 0, 0), kY(0, 1, 0), kZ(0, 0, 1);

inline std::vector<glm::vec3> corners(const SceneData& scene, std::size_t triangle) {
  return {position(scene, triangle, 0), position(scene, triangle, 1), position(scene, triangle, 2)};
}

inline glm::vec2 uv(const SceneData& scene, std::size_t vertex) {
  return {scene.vertices[vertex].uv[0], scene.vertices[vertex].uv[1]};
}

/// A temporary model and the scene loaded from it.
struct GltfTest : ::testing::Test {
  TemporaryFolder folder;
  GltfBuilder model;

  SceneData load() { return load_scene(model.write(folder)); }

  /// A material with that texture image; returns the material.
  json& textured(std::string_view image_base64, const std::string& name = "image.png") {
    folder.write(name, decode_base64(image_base64));
    const int image = model.add("images", {{"uri", name}});
    const int texture = model.add("textures", {{"source", image}});
    model.add("materials",
              {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    return model.document["materials"].back();
  }

  /// A textured triangle with texture coordinates (0,0), (1,0), (0,1).
  json& textured_triangle() {
    const int position = model.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
    const int uv = model.accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
    return model.mesh({{"POSITION", position}, {"TEXCOORD_0", uv}}, {{"material", 0}});
  }
};

/// A valid triangle for tests of invalid changes.
struct BadInputTest : GltfTest {
  BadInputTest() { model.triangle(); }

  /// The error of loading the model; always names the file.
  std::string rejected() {
    const std::string message = rejection(model.write(folder));
    EXPECT_THAT(message, ::testing::HasSubstr("model.gltf"));
    return message;
  }

  /// Gives the triangle a texture with an image of that URI.
  void wear(const std::string& uri) {
    model.document["images"] = {{{"uri", uri}}};
    model.document["textures"] = {{{"source", 0}}};
    model.document["materials"] = {
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    model.document["meshes"][0]["primitives"][0]["material"] = 0;
    model.document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        model.accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
  }

  json& primitive() { return model.document["meshes"][0]["primitives"][0]; }
};

/// The triangle of BadInputTest at node 0, with animations.
struct AnimationTest : BadInputTest {
  /// Adds a channel with its sampler.
  template <typename T>
  json& animate(int node, const std::string& path, const std::vector<float>& times,
                const std::vector<T>& values, const std::string& interpolation = "LINEAR") {
    if (!model.document.contains("animations"))
      model.add("animations", {{"samplers", json::array()}, {"channels", json::array()}});
    json& animation = model.document["animations"].back();
    const std::string type = path == "rotation" ? "VEC4" : path == "weights" ? "SCALAR" : "VEC3";
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation["samplers"].push_back(
        {{"input", model.accessor<float>("SCALAR", times)},
         {"output", model.accessor<T>(type, values, !std::is_same_v<T, float>)},
         {"interpolation", interpolation}});
    return animation;
  }

  MovingScene load() { return MovingScene(model.write(folder)); }
};

/// A small scene in which everything moves from 0 s to 1 s: a wall over a floor, a sun, a lamp and
/// the camera. Returns the scene file.
inline std::filesystem::path write_moving_scene(const TemporaryFolder& folder) {
  GltfBuilder model;
  model.square(2);
  const int wall = model.accessor<float>("VEC3", {0, 0, 0, 0.6f, 0, 0, 0.6f, 1, 0, 0, 1, 0});
  const int corners = model.accessor<std::uint8_t>("SCALAR", {0, 1, 2, 0, 2, 3});
  model.mesh({{"POSITION", wall}}, {{"indices", corners}, {"material", 0}});
  model.document["materials"] = {{{"doubleSided", true}}};
  const json sampler = {{"input", model.accessor<float>("SCALAR", {0, 1})},
                        {"output", model.accessor<float>("VEC3", {-1, 0, 0, 1, 0, 0.5f})}};
  const json channel = {{"sampler", 0}, {"target", {{"node", 1}, {"path", "translation"}}}};
  model.add("animations", {{"samplers", {sampler}}, {"channels", {channel}}});
  model.write(folder);
  return folder.write("moving.json",
                      R"({"model": "model.gltf", "cascades": {"count": 2, "size_metres": 4},
    "cameras": [{"name": "walk", "target": [0, 0.4, 0], "keys": [
      {"time": 0, "eye": [0, 1.5, 3]}, {"time": 1, "eye": [1, 1, 2.5]}]}],
    "lights": [{"name": "sun", "kind": "directional", "illuminance_lux": 10, "keys": [
      {"time": 0, "direction": [0.5, -1, -0.4]}, {"time": 1, "direction": [-0.5, -1, -0.6]}]},
      {"name": "lamp", "kind": "point", "intensity_candela": 1, "keys": [
      {"time": 0, "position": [0, 1, 0]}, {"time": 1, "position": [0.5, 1, 1]}]}]})");
}

}  // namespace clpv::test
