// SPDX-License-Identifier: MIT
// glTF materials, textures and texture coordinates, feature by feature.
#include <glm/gtc/constants.hpp>

#include "tests/support/gltf_builder.hpp"

namespace clpv::test::gltf_material_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct GltfMaterialTest : GltfTest {
  /// Texels of an image that `texture` names.
  std::vector<std::uint8_t> rgba(std::string_view image, const json& texture = {{"source", 0}}) {
    model = GltfBuilder();
    textured(image);
    model.document["textures"] = {texture};
    if (texture.contains("extensions")) model.document["extensionsRequired"] = {"EXT_texture_webp"};
    textured_triangle();
    return load().textures.at(0).rgba;
  }
};

TEST_F(GltfMaterialTest, MaterialFactorsAndFlags) {
  model.document["materials"] = json::parse(R"([
    {"name": "plain", "pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 0.4], "metallicFactor": 1},
     "emissiveFactor": [0.5, 0.25, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 8}}},
    {"name": "mask", "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true},
    {"name": "mask by default", "alphaMode": "MASK"},
    {"name": "glass", "alphaMode": "BLEND", "alphaCutoff": 0.9}])");
  const auto add_glass = [&](json extension, json more) {
    more["extensions"]["KHR_materials_transmission"] = std::move(extension);
    model.document["materials"].push_back(more);
  };
  const json green = {{"baseColorFactor", {0.4, 1, 0.4, 0.1}}},
             factor = {{"transmissionFactor", 1}};
  add_glass(factor, {{"pbrMetallicRoughness", green}, {"alphaMode", "OPAQUE"}});
  add_glass({{"transmissionFactor", 0.4}},
            {{"pbrMetallicRoughness", green}, {"alphaMode", "BLEND"}});
  add_glass(factor, {{"emissiveFactor", {1, 1, 1}}});
  add_glass({{"transmissionFactor", 1}, {"transmissionTexture", {{"index", 0}}}}, {});
  add_glass(json::object(), {});
  model.triangle({{"material", 0}});
  const SceneData scene = load();
  ASSERT_EQ(scene.materials.size(), 9u);
  EXPECT_THAT(scene.materials[0].base_colour, ElementsAre(0.1f, 0.2f, 0.3f, 0.4f))
      << "of a metal too";
  EXPECT_THAT(scene.materials[0].emissive, ElementsAre(4, 2, 8));
  EXPECT_EQ(scene.materials[0].flags, 0u);
  EXPECT_EQ(scene.materials[1].flags, CLPV_MATERIAL_MASKED | CLPV_MATERIAL_DOUBLE_SIDED);
  EXPECT_EQ(scene.materials[1].alpha_cutoff, 0.25f);
  EXPECT_EQ(scene.materials[2].alpha_cutoff, 0.5f);
  EXPECT_EQ(scene.materials[3].flags, CLPV_MATERIAL_MASKED);
  EXPECT_EQ(scene.materials[3].alpha_cutoff, 0.5f) << "BLEND is MASK at one half";
  EXPECT_THAT(scene.notes, ::testing::Contains(HasSubstr("/materials/3 ('glass') blends")));
  EXPECT_EQ(scene.materials[4].flags, CLPV_MATERIAL_MASKED);
  EXPECT_GT(scene.materials[4].alpha_cutoff, 1.f) << "a hole";
  EXPECT_NEAR(scene.materials[5].alpha_cutoff, 0.5 / (1 - 0.4 * 0.6), 1e-6);
  const std::string notes = fmt::format("{}", fmt::join(scene.notes, "\n"));
  EXPECT_THAT(notes,
              AllOf(HasSubstr("/materials/4 ('') transmits 0.6 of light: a hole"),
                    HasSubstr("/materials/5 ('') transmits 0.24 of light: opaque where alpha "
                              "reaches 0.66, a hole elsewhere"),
                    HasSubstr("/materials/6 ('') transmits light: opaque here, since it emits"),
                    HasSubstr("/materials/7 ('') transmits light: opaque here, since it has")));
  for (int i = 6; i < 9; ++i) EXPECT_EQ(scene.materials[i].flags, 0u) << i;
}

TEST_F(GltfMaterialTest, TexturesKeepTheirBytes) {
  textured(kPngRgba2x2);
  textured_triangle();
  const SceneData scene = load();
  ASSERT_EQ(scene.textures.size(), 1u);
  const Texture& texture = scene.textures[0];
  EXPECT_EQ(texture.width, 2u);
  EXPECT_EQ(texture.height, 2u);
  // Row 0 first, colours not multiplied by alpha.
  EXPECT_THAT(texture.rgba,
              ElementsAre(255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 128, 128, 128, 255));
  EXPECT_EQ(scene.materials[0].texture, 0u);
}

TEST_F(GltfMaterialTest, ImagesOfOtherKindsBecomeRgba) {
  EXPECT_THAT(rgba(kPngGrey), ElementsAre(77, 77, 77, 255));
  EXPECT_THAT(rgba(kPngGrey16), ElementsAre(77, 77, 77, 255));
  EXPECT_THAT(rgba(kPngPalette), ElementsAre(10, 20, 30, 255));
  const auto red = rgba(kJpegRed8x8);  // under a name that says PNG: content decides
  ASSERT_EQ(red.size(), 256u);
  EXPECT_NEAR(red[0], 255, 4);
  EXPECT_NEAR(red[1], 0, 4);
  const auto cmyk = rgba(kJpegCmyk8x8);
  EXPECT_THAT(std::vector(cmyk.begin(), cmyk.begin() + 4), ElementsAre(200, 60, 30, 255));
  const auto exif = rgba(kJpegExif16x8);
  EXPECT_NEAR(exif[1], 200, 4) << "rows as stored, whatever Exif says";
}

TEST_F(GltfMaterialTest, WebpIsDecoded) {
  const json webp{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
  EXPECT_THAT(rgba(kWebpRgba2x2, webp),
              ElementsAre(255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 10, 128, 128, 128, 255))
      << "not multiplied by alpha";
  for (const auto& [image, alpha] :
       std::vector<std::pair<std::string_view, int>>{{kWebpLossy, 255}, {kWebpLossyAlpha, 128}}) {
    const auto lossy = rgba(image, webp);
    ASSERT_EQ(lossy.size(), 64u);
    const int expected[] = {200, 100, 50, alpha};
    for (std::size_t i = 0; i < lossy.size(); ++i) EXPECT_NEAR(lossy[i], expected[i % 4], 2) << i;
  }
}

TEST_F(GltfMaterialTest, TexturesByExtensionsAloneLeaveTheFactor) {
  textured(kPngGrey)["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.25, 1, 1};
  GltfTest::model.document["materials"][0]["emissiveFactor"] = {1, 0, 0};
  textured_triangle();
  json& texture = GltfTest::model.document["textures"][0];
  json& material = GltfTest::model.document["materials"][0];
  for (const char* extension :
       {"KHR_texture_basisu", "MSFT_texture_dds", "EXT_texture_avif", "VENDOR_texture"}) {
    texture = {{"extensions", {{extension, {{"source", 0}}}}}};
    GltfTest::model.document["extensionsUsed"] = {extension};
    for (const bool emissive : {false, true}) {
      if (emissive) material["emissiveTexture"] = {{"index", 0}};
      const SceneData scene = load();
      EXPECT_TRUE(scene.textures.empty());
      EXPECT_THAT(scene.materials[0].base_colour, ElementsAre(0.5f, 0.25f, 1, 1));
      EXPECT_EQ(scene.materials[0].texture, CLPV_NO_TEXTURE);
      EXPECT_EQ(scene.materials[0].emissive_texture, CLPV_NO_TEXTURE);
      EXPECT_THAT(scene.notes,
                  ::testing::Contains(AllOf(HasSubstr("/textures/0"), HasSubstr(extension))));
    }
    material.erase("emissiveTexture");
    texture["source"] = 0;  // its own image is for readers without the extension
    EXPECT_THAT(load().textures.at(0).rgba, ElementsAre(77, 77, 77, 255));
  }
  texture = json::object();
  EXPECT_THAT(load().notes, ::testing::Contains(HasSubstr("/textures/0 has no source")));
  material["emissiveTexture"] = {{"index", 1}};  // emission keeps its texture without the other
  GltfTest::model.add("textures", {{"source", 0}});
  const SceneData scene = load();
  EXPECT_EQ(scene.materials[0].texture, CLPV_NO_TEXTURE);
  EXPECT_EQ(scene.materials[0].emissive_texture, 0u);
}

TEST_F(GltfMaterialTest, TheDiffuseColourOfSpecularGlossinessIsTheBaseColour) {
  textured(kPngGrey);
  textured_triangle();
  json& material = GltfTest::model.document["materials"][0];
  material["pbrMetallicRoughness"] = {{"baseColorFactor", {1, 0, 0, 1}}};  // for other readers
  json& given = material["extensions"]["KHR_materials_pbrSpecularGlossiness"];
  given = {{"diffuseFactor", {0.1, 0.2, 0.3, 0.4}}};
  GltfTest::model.document["extensionsUsed"] = {"KHR_materials_pbrSpecularGlossiness"};
  SceneData scene = load();
  EXPECT_THAT(scene.materials[0].base_colour, ElementsAre(0.1f, 0.2f, 0.3f, 0.4f));
  EXPECT_TRUE(scene.textures.empty());
  EXPECT_THAT(scene.notes, ::testing::Not(::testing::Contains(HasSubstr("not read"))));
  given = {{"diffuseTexture",
            {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}}}}}}}};
  scene = load();
  EXPECT_THAT(scene.materials[0].base_colour, ElementsAre(1, 1, 1, 1));
  ASSERT_EQ(scene.materials[0].texture, 0u);
  EXPECT_EQ(uv(scene, scene.triangles[0].vertex[0]), glm::vec2(0.5f, 0));
  given = json::object();
  EXPECT_THAT(load().materials[0].base_colour, ElementsAre(1, 1, 1, 1)) << "its default";
}

TEST_F(GltfMaterialTest, ImagesInBuffersAndDataUris) {
  const std::string png = decode_base64(kPngGrey);
  model.add("images", {{"bufferView", model.view(png)}, {"mimeType", "image/png"}});
  model.add("images", {{"uri", "data:image/png;base64," + std::string(kPngPalette)}});
  for (int i = 0; i < 2; ++i) {
    model.add("textures", {{"source", i}});
    model.add("materials", {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
  }
  textured_triangle();
  const SceneData scene = load_scene(folder.write("model.glb", model.glb()));
  ASSERT_EQ(scene.textures.size(), 2u);
  EXPECT_THAT(scene.textures[0].rgba, ElementsAre(77, 77, 77, 255));
  EXPECT_THAT(scene.textures[1].rgba, ElementsAre(10, 20, 30, 255));
}

TEST_F(GltfMaterialTest, WrapModesComeFromTheSampler) {
  textured(kPngGrey);
  textured_triangle();
  model.document["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}, {{"magFilter", 9728}}};
  model.document["textures"][0]["sampler"] = 0;
  SceneData scene = load();
  EXPECT_EQ(scene.textures[0].wrap_u, CLPV_WRAP_CLAMP);
  EXPECT_EQ(scene.textures[0].wrap_v, CLPV_WRAP_MIRROR);
  model.document["textures"][0]["sampler"] = 1;
  scene = load();
  EXPECT_EQ(scene.textures[0].wrap_u, CLPV_WRAP_REPEAT);
  EXPECT_EQ(scene.textures[0].wrap_v, CLPV_WRAP_REPEAT);
}

TEST_F(GltfMaterialTest, OneImageServesManyMaterials) {
  textured(kPngGrey);
  model.document["materials"].push_back(model.document["materials"][0]);
  textured_triangle();
  EXPECT_EQ(load().textures.size(), 1u);
}

TEST_F(GltfMaterialTest, TextureTransformScalesTurnsAndMoves) {
  json& material = textured(kPngGrey);
  material["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
      {"offset", {0.5, 0.25}}, {"rotation", glm::half_pi<double>()}, {"scale", {2, 4}}};
  model.document["extensionsRequired"] = {"KHR_texture_transform"};
  textured_triangle();
  const SceneData scene = load();
  EXPECT_THAT(uv(scene, 0), IsNear(glm::vec2(0.5f, 0.25f), kClose));
  EXPECT_THAT(uv(scene, 1), IsNear(glm::vec2(0.5f, -1.75f), kClose))
      << "u turns towards -v, upwards in the image";
  EXPECT_THAT(uv(scene, 2), IsNear(glm::vec2(4.5f, 0.25f), kClose));
}

TEST_F(GltfMaterialTest, TextureCoordinateSets) {
  json& texture = textured(kPngGrey)["pbrMetallicRoughness"]["baseColorTexture"];
  const int position = model.accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int first = model.accessor<float>("VEC2", {0, 0, 1, 0, 0, 1});
  const int second = model.accessor<float>("VEC2", {7, 7, 8, 8, 9, 9});
  model.mesh({{"POSITION", position}, {"TEXCOORD_0", first}, {"TEXCOORD_3", second}},
             {{"material", 0}});
  EXPECT_EQ(uv(load(), 0), glm::vec2(0));
  texture["texCoord"] = 3;
  EXPECT_EQ(uv(load(), 0), glm::vec2(7));
  texture["texCoord"] = 0;
  texture["extensions"]["KHR_texture_transform"] = {{"texCoord", 3}};
  EXPECT_EQ(uv(load(), 0), glm::vec2(7)) << "the extension overrides";
  texture["extensions"]["KHR_texture_transform"] = {{"texCoord", 5}};
  EXPECT_THAT(load().notes, ::testing::Contains(HasSubstr("TEXCOORD_5")));
}

TEST_F(GltfMaterialTest, EmissiveTextures) {
  json& material = textured(kPngGrey);
  material["emissiveTexture"] = {{"index", 0}, {"texCoord", 1}};
  textured_triangle();
  EXPECT_EQ(load().materials[0].emissive_texture, CLPV_NO_TEXTURE) << "the factor is 0";
  material["emissiveFactor"] = {1, 1, 1};
  SceneData scene = load();
  EXPECT_EQ(scene.materials[0].emissive_texture, 0u);
  EXPECT_THAT(scene.notes, ::testing::Contains(HasSubstr("/materials/0/emissiveTexture")));
  material["emissiveTexture"].erase("texCoord");
  EXPECT_THAT(load().notes, Not(::testing::Contains(HasSubstr("emissiveTexture"))));
  material.erase("pbrMetallicRoughness");
  scene = load();
  EXPECT_EQ(scene.materials[0].texture, CLPV_NO_TEXTURE);
  EXPECT_EQ(uv(scene, 1), glm::vec2(1, 0))
      << "without a base-colour texture its own coordinates serve";
}

}  // namespace
}  // namespace clpv::test::gltf_material_test
