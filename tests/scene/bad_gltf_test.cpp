// SPDX-License-Identifier: MIT
// Invalid models: each is rejected with a message and exit code 3 (bad_input), before memory of the
// requested size is allocated.
#include "tests/support/gltf_builder.hpp"
#include "tests/support/run_here.hpp"

namespace clpv::test::bad_gltf_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Values of a document, by JSON pointers; null removes the member.
using Changes = std::vector<std::pair<std::string, json>>;

struct Row {
  Changes changes;
  std::vector<std::string> words;  ///< words of the rejection
};

void change(json& document, const Changes& changes) {
  for (const auto& [place, value] : changes) {
    const json::json_pointer pointer(place);
    if (value.is_null()) {
      document.at(pointer.parent_pointer()).erase(pointer.back());
    } else {
      document[pointer] = value;
    }
  }
}

/// A model with one of everything: a textured, skinned triangle with a morph target and sparse
/// positions, which moves.
struct BadGltfTest : AnimationTest {
  BadGltfTest() {
    folder.write("image.png", decode_base64(kPngGrey));
    wear("image.png");
    primitive()["indices"] = model.accessor<std::uint8_t>("SCALAR", {0, 1, 2});
    attributes()["JOINTS_0"] =
        model.accessor<std::uint8_t>("VEC4", std::vector<std::uint8_t>(12, 0));
    attributes()["WEIGHTS_0"] = model.accessor<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    primitive()["targets"] = {
        {{"POSITION", model.accessor<float>("VEC3", std::vector<float>(9, 0))}}};
    model.make_sparse(0, {0, 2}, {0, 0, 0, 0, 1, 0});
    model.document["samplers"] = json::array({json::object()});
    model.document["scenes"] = {{{"nodes", {0, 1}}}};
    model.document["cameras"] =
        json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}])");
    model.document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", json::object()}}};
    model.document["nodes"][0]["skin"] = 0;
    model.document["skins"] = {{{"joints", {1}}}};
    model.add("nodes", {{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    animate<float>(1, "translation", {0, 1}, {0, 0, 0, 1, 1, 1});
  }

  json& attributes() { return primitive()["attributes"]; }
  json& attributes_of_instances() {
    return model.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  }
  int floats(const std::string& type, const std::vector<float>& values) {
    return model.accessor<float>(type, values);
  }

  void expect_all_rejected(const std::vector<Row>& rows) {
    ASSERT_EQ(load_scene(model.write(folder)).triangles.size(), 1u);
    const json sound = model.document;
    for (const Row& row : rows) {
      change(model.document, row.changes);
      const std::string message = rejected();
      EXPECT_THAT(message, HasSubstr("; allowed: "));
      for (const std::string& word : row.words)
        EXPECT_THAT(message, HasSubstr(word)) << row.changes[0].first;
      model.document = sound;
    }
  }
};

const std::string kPrimitive = "/meshes/0/primitives/0",
                  kLights = "/extensions/KHR_lights_punctual/lights";

TEST_F(BadGltfTest, EveryIndexOutOfRange) {
  std::vector<Row> rows;
  for (const std::string& place :
       words_of("/scene /scenes/0/nodes/0 /nodes/0/children/0 /nodes/0/mesh /nodes/1/camera "
                "/nodes/0/skin /nodes/1/extensions/KHR_lights_punctual/light /skins/0/joints/0 "
                "/skins/0/inverseBindMatrices /meshes/0/primitives/0/indices "
                "/meshes/0/primitives/0/material /meshes/0/primitives/0/attributes/POSITION "
                "/meshes/0/primitives/0/targets/0/POSITION /accessors/0/bufferView "
                "/accessors/0/sparse/indices/bufferView /accessors/0/sparse/values/bufferView "
                "/bufferViews/0/buffer /materials/0/pbrMetallicRoughness/baseColorTexture/index "
                "/materials/0/emissiveTexture/index /textures/0/source /textures/0/sampler "
                "/images/0/bufferView /animations/0/samplers/0/input "
                "/animations/0/samplers/0/output /animations/0/channels/0/target/node")) {
    for (const json& bad :
         {json(1000), json(-1), json(18446744073709551615ull), json(1.5), json("0")})
      rows.push_back({{{place, bad}}, {place + ": found " + bad.dump()}});
  }
  expect_all_rejected(rows);
}

TEST_F(BadGltfTest, Documents) {
  const std::string camera = "/cameras/0/perspective",
                    texture = "/materials/0/pbrMetallicRoughness";
  expect_all_rejected({
      {{{"/asset", nullptr}}, {"/asset", "nothing"}},
      {{{"/asset/version", "1.0"}}, {"/asset/version", "'1.0'", "2.x"}},
      {{{"/asset/version", 2}}, {"/asset/version"}},
      {{{"/asset/minVersion", "2.1"}}, {"/asset/minVersion", "'2.1'", "2.0"}},
      {{{"/extensionsRequired", {"KHR_texture_transform", "KHR_draco_mesh_compression"}}},
       {"/extensionsRequired/1", "'KHR_draco_mesh_compression'", "KHR_lights_punctual"}},
      {{{"/extensionsRequired",
         {"\x1b[2J\xc2\x9b"
          "0m"}}},
       {"'?[2J?0m'"}},
      {{{"/materials", 7}}, {"/materials", "found 7", "an array"}},
      {{{"/materials/0/doubleSided", "yes"}},
       {"/materials/0/doubleSided", "\"yes\"", "true or false"}},
      {{{texture + "/baseColorFactor", {1, 1, "red", 1}}},
       {texture + "/baseColorFactor", "\"red\""}},
      {{{"/images/0", json::object()}}, {"/images/0", "image[0]"}},
      {{{"/images/0/bufferView", 0}}, {"/images/0", "image[0]"}},
      {{{"/images/0/uri", "data:image/png;base64,!!"}}, {"/images/0", "decode"}},
      {{{camera + "/yfov", 4}}, {camera + "/yfov", "found 4"}},
      {{{camera, nullptr}}, {"/cameras/0"}},
      {{{kLights + "/0/spot", 7}}, {kLights + "/0/spot", "found 7"}},
      {{{kLights + "/0/type", "area"}}, {"lights/0/type", "\"area\"", "directional, spot, point"}},
      {{{kLights + "/0/spot", {{"innerConeAngle", 0.5}, {"outerConeAngle", 0.5 - 1e-12}}}},
       {kLights + "/0/spot", "inner less"}},
      {{{kLights + "/0/spot/innerConeAngle", 1.5708}}, {"innerConeAngle: found 1.5708"}},
      {{{kLights + "/0/spot/outerConeAngle", 1.5708}}, {"outerConeAngle: found 1.5708"}},
      {{{kLights + "/0/spot/outerConeAngle", 0}}, {"outerConeAngle: found 0"}},
  });
}

TEST_F(BadGltfTest, Instances) {
  const std::string node = "/nodes/0/extensions/EXT_mesh_gpu_instancing",
                    attributes = node + "/attributes";
  const int two = floats("VEC3", {0, 0, 0, 1, 0, 0}), three = floats("VEC3", std::vector<float>(9)),
            turns = floats("VEC4", {0, 0, 0, 1, 0, 0, 0, 0.1f}), nan = floats("VEC3", {0, NAN, 0}),
            words = model.accessor<std::uint16_t>("VEC3", {0, 0, 0}),
            many = model.add("accessors",
                             {{"componentType", 5126}, {"count", 3000000000u}, {"type", "VEC3"}});
  model.document["nodes"][0].erase("skin");
  attributes_of_instances() = {{"TRANSLATION", floats("VEC3", {0, 0, 0})}};
  expect_all_rejected({
      {{{node, 7}}, {node, "found 7"}},
      {{{attributes, nullptr}}, {attributes, "nothing"}},
      {{{attributes, json::object()}}, {attributes, "no attribute"}},
      {{{attributes, {{"_ID", two}}}}, {attributes, "no attribute"}},
      {{{attributes + "/TRANSLATION", 1000}}, {attributes + "/TRANSLATION", "1000"}},
      {{{attributes, {{"TRANSLATION", two}, {"SCALE", three}}}},
       {attributes + "/SCALE", "3 of VEC3", "2 of VEC3"}},
      {{{attributes, {{"ROTATION", two}}}}, {attributes + "/ROTATION", "VEC4"}},
      {{{attributes, {{"ROTATION", turns}}}},
       {attributes + "/ROTATION", "a quaternion of length 0.1", "1"}},
      {{{attributes, {{"SCALE", nan}}}}, {attributes + "/SCALE", "nan"}},
      {{{attributes, {{"SCALE", words}}}}, {attributes + "/SCALE", "5123"}},
      {{{attributes, {{"SCALE", many}}}}, {attributes, "3000000000 more instances", "262144"}},
      {{{attributes, {{"SCALE", many}, {"TRANSLATION", many}}}, {"/nodes/0/skin", 0}},
       {attributes, "3000000000 more instances"}},
  });
}

TEST_F(BadGltfTest, TexturesByExtensions) {
  const std::string texture = "/textures/0/extensions/EXT_texture_webp",
                    material = "/materials/0/extensions/KHR_materials_pbrSpecularGlossiness";
  expect_all_rejected({
      {{{"/textures/0/extensions", 7}}, {"/textures/0/extensions", "found 7"}},
      {{{texture, "webp"}}, {texture, "an object"}},
      {{{texture + "/source", 1}}, {texture + "/source", "found 1"}},
      {{{material, 7}}, {material, "found 7"}},
      {{{material + "/diffuseFactor", {1, 1, 2, 1}}}, {material + "/diffuseFactor", "with 2"}},
      {{{material + "/diffuseTexture", json::object()}}, {material + "/diffuseTexture/index"}},
      {{{material + "/diffuseTexture/index", 1}}, {material + "/diffuseTexture/index", "found 1"}},
      {{{"/extensionsRequired", {"KHR_texture_basisu"}}},
       {"/extensionsRequired/0", "KHR_texture_basisu", "EXT_texture_webp"}},
  });
}

TEST_F(BadGltfTest, Nodes) {
  const json identity = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const json projective = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2};
  expect_all_rejected({
      {{{"/nodes/0/children", {0}}}, {"/scenes/0/nodes", "node 0, a child of node 0"}},
      {{{"/nodes/0/children", {1}}, {"/nodes/1/children", {0}}, {"/scenes", nullptr}},
       {"/nodes", "a cycle"}},
      {{{"/nodes/2", {{"children", {1}}}}, {"/nodes/0/children", {1}}},
       {"/nodes/1", "parents 0 and 2"}},
      {{{"/scenes/0/nodes", {0, 1, 0}}}, {"/scenes/0/nodes", "node 0 twice"}},
      {{{"/scenes/0/nodes", {0}}}, {"/skins/0/joints", "node 1", "nodes of the scene"}},
      {{{"/nodes/1/scale", {1e29, 1, 1}}}, {"vertex 1", "/nodes/0", "within"}},
      {{{"/nodes/1/scale", {1e200, 1, 1}}}, {"/nodes/1/scale"}},
      {{{"/nodes/1/rotation", {0, 0, 0, 0}}}, {"/nodes/1/rotation", "a unit quaternion"}},
      {{{"/nodes/0/matrix", std::vector<int>(15, 1)}}, {"/nodes/0/matrix"}},
      {{{"/nodes/1/matrix", identity}}, {"/nodes/1/matrix", "translation by /animations/0"}},
      {{{"/nodes/0/matrix", projective}}, {"/nodes/0/matrix", "last row 0, 0, 0, 2"}},
      {{{"/nodes/0/matrix", identity}, {"/nodes/0/scale", {1, 1, 1}}},
       {"/nodes/0", "a matrix, and a translation, rotation or scale"}},
      {{{"/nodes/0/weights", {1, 2, 3}}},
       {"/nodes/0/weights", "3 weights", "each of 1 morph targets"}},
      {{{"/nodes/0/weights", {"half"}}}, {"/nodes/0/weights/0"}},
      {{{"/meshes/0/weights", {1, 2}}}, {"/meshes/0/weights", "2 weights"}},
  });
  constexpr int kLevels = 20000;  // each once took longer than the one before it
  for (int i = 2; i < kLevels; ++i) model.add("nodes", {{"children", {i + 1}}});
  model.add("nodes", json::object());
  model.document["scenes"][0]["nodes"] = {0, 1, 2};
  EXPECT_THAT(rejected(), AllOf(HasSubstr("levels deep"), HasSubstr("at most 1024")));
}

TEST_F(BadGltfTest, Attributes) {
  const int nan = floats("VEC3", {0, 0, 0, 0, NAN, 0, 0, 0, 0}),
            pairs = floats("VEC2", {0, 0, 0, 0, 0, 0}), one = floats("VEC3", {0, 0, 0}),
            infinite = floats("VEC3", {0, 0, 0, 0, 0, 0, 0, 0, INFINITY}),
            far = floats("VEC3", {0, 0, 0, 1e8f, 0, 0, 0, 0, 0}),
            scalars = floats("SCALAR", {0, 1, 2}),
            outside = model.accessor<std::uint16_t>("SCALAR", {0, 1, 3}),
            four = model.accessor<std::uint8_t>("SCALAR", {0, 1, 2, 0}),
            largest = model.accessor<std::uint32_t>("SCALAR", {0, 1, 0xffffffffu}),
            zeros = model.add("accessors",
                              {{"componentType", 5126}, {"count", 3000000000u}, {"type", "VEC3"}}),
            unbound = model.accessor<std::uint16_t>("VEC4", {0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, 0}),
            weights = floats("VEC4", {1, 0, 0, 0, 1, -1, 0, 0, 1, 0, 0, 0}),
            few_weights = floats("VEC4", {1, 0, 0, 0});
  const std::string attributes = kPrimitive + "/attributes", position = attributes + "/POSITION",
                    indices = kPrimitive + "/indices", skin = "/skins/0/inverseBindMatrices";
  expect_all_rejected({
      {{{attributes, json::object()}}, {kPrimitive, "no attribute POSITION"}},
      {{{"/meshes/0/primitives", json::array()}}, {"/meshes/0/primitives"}},
      {{{attributes + "/NORMAL", one}}, {attributes + "/NORMAL", "1 of VEC3", "3 of VEC3"}},
      {{{attributes + "/NORMAL", pairs}}, {attributes + "/NORMAL", "VEC2", "VEC3"}},
      {{{attributes + "/NORMAL", nan}},
       {attributes + "/NORMAL", "nan in component 1 of element 1", "finite"}},
      {{{position, infinite}}, {position, "inf in component 2 of element 2"}},
      {{{position, far}, {"/nodes/0/skin", nullptr}},
       {"vertex 1", "(100000000, 0, 0) m", "within"}},
      {{{indices, outside}}, {kPrimitive, "index 3 of element 2", "0 to 2"}},
      {{{indices, largest}}, {kPrimitive, "index 4294967295 of element 2"}},
      {{{indices, scalars}}, {indices, "componentType 5126", "SCALAR of unsigned integers"}},
      {{{indices, four}}, {kPrimitive, "4 corners", "multiple of 3"}},
      {{{indices, zeros}}, {"/meshes/0/primitives", "no bufferView"}},
      {{{position, zeros}, {indices, nullptr}, {attributes + "/TEXCOORD_0", nullptr}},
       {kPrimitive, "1000000000 more triangles"}},
      {{{attributes + "/JOINTS_0", unbound}},
       {attributes + "/JOINTS_0", "joint 2 of vertex 1", "0 to 0"}},
      {{{attributes + "/JOINTS_0", weights}},
       {attributes + "/JOINTS_0", "5126", "componentType 5121 or 5123"}},
      {{{attributes + "/WEIGHTS_0", nullptr}}, {"JOINTS_0 without WEIGHTS_0"}},
      {{{attributes + "/WEIGHTS_0", weights}},
       {attributes + "/WEIGHTS_0", "-1 in component 1 of vertex 1"}},
      {{{attributes + "/WEIGHTS_0", few_weights}}, {attributes + "/WEIGHTS_0", "3 of VEC4"}},
      {{{skin, one}}, {skin, "1 of VEC3", "MAT4 of floats"}},
      {{{kPrimitive + "/targets/0/POSITION", one}},
       {kPrimitive + "/targets/0/POSITION", "3 of VEC3"}},
      {{{kPrimitive + "/targets/0/POSITION", nan}}, {kPrimitive + "/targets/0/POSITION", "nan"}},
      {{{"/meshes/0/primitives/1", {{"attributes", {{"POSITION", 0}}}}}},
       {"/meshes/0/primitives/1/targets", "0 morph targets", "first primitive has, 1"}},
  });
}

TEST_F(BadGltfTest, BuffersViewsAndAccessors) {
  const std::string accessor = "/accessors/0", view = "/bufferViews/0",
                    sparse = accessor + "/sparse";
  const int outside = model.view(bytes_of<std::uint16_t>({0, 3})),
            falling = model.view(bytes_of<std::uint16_t>({2, 1}));
  std::vector<Row> rows = {
      {{{accessor + "/count", 4}}, {accessor, "up to byte 48", "36 bytes of " + view}},
      {{{accessor + "/byteOffset", 4}}, {accessor, "up to byte 40"}},
      {{{accessor + "/byteOffset", -12}}, {accessor + "/byteOffset", "-12"}},
      {{{accessor + "/type", "VEC5"}}, {accessor + "/type", "VEC5"}},
      {{{accessor + "/componentType", 5130}}, {accessor + "/componentType"}},
      {{{sparse + "/indices/bufferView", outside}},
       {sparse + "/indices", "index 3 at 1", "below 3"}},
      {{{sparse + "/indices/bufferView", falling}}, {sparse + "/indices", "index 1 at 1"}},
      {{{sparse + "/count", 3}}, {accessor, "3 elements up to byte 6"}},
      {{{sparse + "/values/byteOffset", 2147483647}}, {accessor, "up to byte 2147483671"}},
      {{{view + "/byteStride", 8}}, {accessor, "12 bytes", "byteStride 8"}},
      {{{view + "/byteStride", 16}}, {accessor, "up to byte 44"}},
      {{{view + "/byteLength", 4096}}, {view, "bytes up to 4096"}},
      {{{view + "/byteOffset", 4294967295u}}, {view, "bytes up to 4294967331"}},
  };
  for (const std::uint64_t count :
       {0xffffffffull, 0x1555555555555556ull, 0xffffffffffffffffull, 0ull})
    rows.push_back({{{accessor + "/count", count}}, {accessor, std::to_string(count)}});
  for (const int stride : {0, 3, 14, 256, -4})
    rows.push_back({{{view + "/byteStride", stride}}, {view, std::to_string(stride)}});
  expect_all_rejected(rows);
  const auto rejected_with = [&](const Changes& changes) {
    const json sound = model.document;
    model.finish("model.bin");
    folder.write("model.bin", model.binary);
    change(model.document, changes);
    const std::string message = rejection(folder.write("model.gltf", model.document.dump()));
    model.document = sound;
    return message;
  };
  const std::string size = "/buffers/0/byteLength", uri = "/buffers/0/uri";
  EXPECT_THAT(rejected_with({{size, 1 << 20}}),
              AllOf(HasSubstr(size), HasSubstr("1048576"), HasSubstr("truncated")));
  EXPECT_THAT(rejected_with({{size, 1ull << 40}}),
              AllOf(HasSubstr(size), HasSubstr("1099511627776")));
  EXPECT_THAT(rejected_with({{"/buffers/1", {{"byteLength", 1u << 31}, {"uri", "model.bin"}}}}),
              AllOf(HasSubstr("/buffers/1/byteLength"), HasSubstr("in all")));
  EXPECT_THAT(rejected_with({{uri, "data:application/octet-stream;base64,!!"}}),
              AllOf(HasSubstr(uri), HasSubstr("not base64")));
  EXPECT_THAT(rejected_with({{uri, "data:;base64,AAAAA"}}), HasSubstr("not base64"));
  EXPECT_THAT(rejected_with({{uri, "data:;base64"}}), HasSubstr("without a comma"));
  EXPECT_THAT(rejected_with({{uri, "data:,%4"}}), HasSubstr("percent-encoding"));
  EXPECT_THAT(rejected_with({{uri, "data:text/html;base64,AAAA"}}),
              AllOf(HasSubstr(size), HasSubstr("3 bytes of the URI")));
  EXPECT_THAT(rejected_with({{uri, "dat:text/html;base64,AAAA"}}),
              AllOf(HasSubstr(uri), HasSubstr("no such file")));
  for (const json& none : {json(), json("")})
    EXPECT_THAT(rejected_with({{uri, none}}), AllOf(HasSubstr("/buffers/0"), HasSubstr("no uri")));
  EXPECT_THAT(rejected_with({{"/buffers/1", {{"byteLength", 1}}}}),
              AllOf(HasSubstr("/buffers/1"), HasSubstr("no uri")));
}

TEST_F(BadGltfTest, Animations) {
  const std::string animation = "/animations/0", input = animation + "/samplers/0/input",
                    output = animation + "/samplers/0/output", channel = animation + "/channels/0";
  const auto times = [&](float a, float b) { return floats("SCALAR", {a, b}); };
  const int shorts = model.accessor<std::uint16_t>("SCALAR", {0, 1}),
            three = floats("VEC3", std::vector<float>(9, 0)),
            still = floats("VEC4", {0, 0, 0, 1, 0, 0, 0, 0.1f}),
            nan = floats("VEC3", {0, 0, 0, 1, NAN, 1}), scalars = floats("SCALAR", {0, 1, 2}),
            integers = model.accessor<std::uint32_t>("VEC3", {0, 0, 0, 1, 1, 1}),
            many_times = model.add(
                "accessors", {{"componentType", 5126}, {"count", 100000000}, {"type", "SCALAR"}}),
            many = model.add("accessors",
                             {{"componentType", 5126}, {"count", 100000000}, {"type", "VEC3"}});
  expect_all_rejected({
      {{{input, times(2, 1)}}, {input, "1 s at 1", "more than the 2 s"}},
      {{{input, times(1, 1)}}, {input, "1 s at 1", "more than the 1 s"}},
      {{{input, times(0, NAN)}}, {input, "nan", "finite"}},
      {{{input, times(0, INFINITY)}}, {input, "inf", "finite"}},
      {{{input, times(-1, 0)}}, {input, "-1 s at 0", "from 0 s on"}},
      {{{input, shorts}}, {input, "componentType 5123", "SCALAR of floats"}},
      {{{input, three}}, {input, "VEC3", "SCALAR of floats"}},
      {{{output, three}}, {output, "3 of VEC3", "2 of VEC3"}},
      {{{output, integers}}, {output, "5125", "VEC3 of floats"}},
      {{{output, nan}}, {output, "nan in component 1 of element 1"}},
      {{{animation + "/samplers/0/interpolation", "CUBICSPLINE"}}, {output, "6 of VEC3"}},
      {{{animation + "/samplers/0/interpolation", "CUBIC"}}, {"LINEAR, STEP, CUBICSPLINE"}},
      {{{channel + "/target/path", "rotation"}}, {output, "VEC4"}},
      {{{channel + "/target/path", "rotation"}, {output, still}},
       {output, "a quaternion of length 0.1", "at 1"}},
      {{{channel + "/target", {{"node", 0}, {"path", "weights"}}}, {output, scalars}},
       {output, "2 of SCALAR"}},
      {{{channel + "/target/path", "colour"}}, {channel + "/target/path", "translation, rotation"}},
      {{{channel + "/sampler", 1000}}, {animation, "sampler 1000", "0 to 0"}},
      {{{channel + "/sampler", -1}}, {channel + "/sampler: found -1"}},
      {{{animation + "/samplers", nullptr}}, {animation + "/samplers", "nothing"}},
      {{{input, many_times}, {output, many}},
       {animation + "/samplers/0", "400000000 times and values", "16777216"}},
  });
  const std::string flood(bounds::kJsonValues / 2, 'x');  // tinygltf copies it for each sampler
  json& moving = model.document["animations"][0];
  moving["extensions"]["EXT_flood"]["text"] = flood;
  EXPECT_EQ(load_scene(model.write(folder)).triangles.size(), 1u);
  for (int i = 0; i < 3; ++i) moving["samplers"].push_back(moving["samplers"][0]);
  EXPECT_THAT(rejected(), HasSubstr("/animations/0/extensions"));
}

TEST_F(BadGltfTest, TooManyInstancesAndMorphTargets) {
  GltfBuilder many;
  std::vector<std::uint32_t> corners(99999);
  for (std::size_t i = 0; i < corners.size(); ++i) corners[i] = static_cast<std::uint32_t>(i);
  const int zeros =
      many.add("accessors", {{"componentType", 5126}, {"count", 99999}, {"type", "VEC3"}});
  many.mesh({{"POSITION", zeros}}, {{"indices", many.accessor<std::uint32_t>("SCALAR", corners)}});
  model = many;
  for (int i = 0; i < 20000; ++i) model.add("nodes", {{"mesh", 0}});
  EXPECT_THAT(rejected(), AllOf(HasSubstr(kPrimitive), HasSubstr("2000079999 vertices"),
                                HasSubstr("20001 places")));
  model = many;
  model.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] =
      model.add("accessors", {{"componentType", 5126}, {"count", 1 << 18}, {"type", "VEC3"}});
  EXPECT_THAT(rejected(), AllOf(HasSubstr(kPrimitive), HasSubstr("262144 places")));
  model.document["nodes"].push_back(model.document["nodes"][0]);
  EXPECT_THAT(rejected(), AllOf(HasSubstr("/nodes/1"), HasSubstr("262144 more instances")));
  model = many;
  for (int i = 0; i < 1000; ++i) primitive()["targets"].push_back({{"POSITION", zeros}});
  EXPECT_THAT(rejected(), AllOf(HasSubstr(kPrimitive + "/targets/223"),
                                HasSubstr("299997 more numbers"), HasSubstr("67108864 in all")));
}

TEST_F(BadGltfTest, PosesBeyondTheBoundsAreRejected) {
  // A spline from a rotation to its negative with zero tangents has length 0 half way; a node
  // leaves the bounds.
  animate<float>(0, "rotation", {0, 1},
                 {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0},
                 "CUBICSPLINE");
  animate<float>(0, "translation", {0, 0.9f, 1}, {0, 0, 0, 0, 0, 0, 1e30f, 0, 0});
  model.document["nodes"][0].erase("skin");
  MovingScene moving = load();
  moving.pose(0.4);
  EXPECT_THAT(error_of(ExitCode::bad_input, [&] { moving.pose(0.5); }),
              AllOf(HasSubstr("model.gltf: /nodes/0/rotation"), HasSubstr("at 0.5 s")));
  EXPECT_THROW(moving.pose(1), Error);
  moving.pose(0);
  EXPECT_THAT(position(moving.scene(), 0, 0), IsNear(glm::vec3(0), 0.0f));
}

struct BadImageTest : BadInputTest {
  std::string rejected_image(const std::string& bytes) {
    folder.write("image.png", bytes);
    return rejected();
  }
  BadImageTest() { wear("image.png"); }
};

TEST_F(BadImageTest, Images) {
  std::string png = decode_base64(kPngRgba2x2), jpeg = decode_base64(kJpegRed8x8), corrupt = png,
              text = png, large = png;
  for (const std::size_t at : {16, 20}) png.replace(at, 4, std::string("\0\0\xea\x60", 4));
  EXPECT_THAT(rejected_image(png),
              AllOf(HasSubstr("/images/0"), HasSubstr("60000 x 60000"), HasSubstr("16384")));
  jpeg.replace(jpeg.find("\xff\xc0") + 5, 4, "\xff\xdc\xff\xdc");
  EXPECT_THAT(rejected_image(jpeg), AllOf(HasSubstr("/images/0"), HasSubstr("65500 x 65500")));
  for (std::size_t i = 43; i < 52; ++i) corrupt[i] = '\x55';  // inside the compressed pixels
  EXPECT_THAT(rejected_image(corrupt), AllOf(HasSubstr("/images/0"), HasSubstr("does not decode")));
  text.insert(33, "\x7f\xff\xff\xffzTXtComment");
  EXPECT_THAT(rejected_image(text), AllOf(HasSubstr("/images/0"), HasSubstr("truncated")));
  EXPECT_THAT(rejected_image("#!/bin/sh\necho hello, this is no image at all\n"),
              AllOf(HasSubstr("'image.png'"), HasSubstr("23 21 2f 62"),
                    HasSubstr("PNG, JPEG or still WebP")));
  for (const std::string_view encoded : {kPngRgba2x2, kJpegRed8x8}) {
    const std::string image = decode_base64(encoded);
    for (std::size_t length = 0; length + 12 < image.size(); length += 7)
      EXPECT_THAT(rejected_image(image.substr(0, length)), HasSubstr("/images/0")) << length;
  }
  for (const std::size_t at : {16, 20})
    large.replace(at, 4, std::string("\0\0\x40\0", 4));  // 16384: 1 GiB each
  model.document["images"].push_back({{"uri", "image.png"}});
  model.document["textures"].push_back({{"source", 1}});
  model.document["materials"].push_back(
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}}}});
  EXPECT_THAT(rejected_image(large),
              AllOf(HasSubstr("/images/1"), HasSubstr("bytes of texels"), HasSubstr("1073741824")));
}

}  // namespace
}  // namespace clpv::test::bad_gltf_test
