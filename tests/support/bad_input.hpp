// SPDX-License-Identifier: MIT
// The common ground of tests that spoil a sound model, or move it.
#pragma once

#include "scene/bounds.hpp"
#include "tests/support/gltf_builder.hpp"

namespace clpv::test {

struct BadInputTest : GltfTest {
  BadInputTest() { model.triangle(); }

  /// The rejection of the model as it stands; always names the file.
  std::string rejected() {
    const std::string message = rejection(model.write(folder));
    EXPECT_THAT(message, ::testing::HasSubstr("model.gltf"));
    return message;
  }

  /// Makes the triangle wear an image of that URI.
  void wear(const std::string& uri) {
    model.document["images"] = {{{"uri", uri}}};
    model.document["textures"] = {{{"source", 0}}};
    model.document["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    model.document["meshes"][0]["primitives"][0]["material"] = 0;
    model.document["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        model.accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
  }

  json& primitive() { return model.document["meshes"][0]["primitives"][0]; }
  json& accessor() { return model.document["accessors"][0]; }
};

/// The triangle of BadInputTest at node 0, and what moves it.
struct AnimationTest : BadInputTest {
  /// A channel with a sampler of its own.
  template <typename T>
  json& animate(int node, const std::string& path, const std::vector<float>& times,
                const std::vector<T>& values, const std::string& interpolation = "LINEAR") {
    if (!model.document.contains("animations"))
      model.add("animations", {{"samplers", json::array()}, {"channels", json::array()}});
    json& animation = model.document["animations"].back();
    const std::string type = path == "rotation" ? "VEC4" : path == "weights" ? "SCALAR" : "VEC3";
    animation["channels"].push_back(
        {{"sampler", animation["samplers"].size()}, {"target", {{"node", node}, {"path", path}}}});
    animation["samplers"].push_back({{"input", model.accessor<float>("SCALAR", times)},
                                     {"output", model.accessor<T>(type, values, !std::is_same_v<T, float>)},
                                     {"interpolation", interpolation}});
    return animation;
  }

  MovingScene load() { return MovingScene(model.write(folder)); }
  json& sampler() { return model.document["animations"][0]["samplers"][0]; }
  json& accessor_of(const char* which) {
    return model.document["accessors"][sampler()[which].get<std::size_t>()];
  }
};

}  // namespace clpv::test
