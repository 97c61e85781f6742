// SPDX-License-Identifier: MIT
// The common ground of tests that must be refused: a sound model to spoil.
#pragma once

#include "scene/bounds.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/tiny_images.hpp"

namespace clpv::test {

struct BadInputTest : ::testing::Test {
  TemporaryFolder folder;
  GltfBuilder model;

  BadInputTest() { model.triangle(); }

  /// The refusal of the model as it stands; always names the file.
  std::string refused() {
    const std::string message = refusal(model.write(folder));
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

}  // namespace clpv::test
