// SPDX-License-Identifier: MIT
// Hostile and broken glTF, one a test: node graphs, indices, accessors, buffers, cameras and lights. Each is refused
// before anything of the size it asks for is allocated.
#include "tests/support/bad_input.hpp"

namespace clpv::test::bad_gltf_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct BadGltfTest : BadInputTest {};

TEST_F(BadGltfTest, ModelsForReadersOfLaterVersions) {
  model.document["asset"]["minVersion"] = "2.1";
  EXPECT_THAT(refused(), AllOf(HasSubstr("/asset/minVersion"), HasSubstr("'2.1'"), HasSubstr("2.0")));
  model.document["asset"]["minVersion"] = 2;
  EXPECT_THAT(refused(), HasSubstr("/asset/minVersion"));
  model.document["asset"] = {{"version", "2.1"}, {"minVersion", "2.0"}};
  EXPECT_NO_THROW(load_scene(model.write(folder)));
}

TEST_F(BadGltfTest, CyclesInTheNodeGraph) {
  model.document["nodes"] =
      json::parse(R"([{"children": [1]}, {"children": [2]}, {"children": [0], "mesh": 0}])");
  EXPECT_THAT(refused(), AllOf(HasSubstr("/nodes/"), HasSubstr("a cycle")));
  model.document["nodes"] = json::parse(R"([{"children": [0]}])");
  EXPECT_THAT(refused(), HasSubstr("a cycle"));
  model.document["nodes"] = json::parse(R"([{"mesh": 0}, {"children": [2]}, {"children": [1]}])");
  EXPECT_THAT(refused(), HasSubstr("a cycle")) << "out of the scene's reach too";
}

TEST_F(BadGltfTest, NodesWithSeveralParents) {
  model.document["nodes"] = json::parse(R"([{"children": [2]}, {"children": [2]}, {"mesh": 0}])");
  EXPECT_THAT(refused(), AllOf(HasSubstr("/nodes/2"), HasSubstr("parents 0 and 1")));
}

TEST_F(BadGltfTest, NodesTooDeep) {
  constexpr int kLevels = 200000;
  json& nodes = model.document["nodes"] = json::array();
  for (int i = 0; i + 1 < kLevels; ++i) nodes.push_back({{"children", {i + 1}}});
  nodes.push_back({{"mesh", 0}});
  EXPECT_THAT(refused(), AllOf(HasSubstr("levels deep"), HasSubstr("at most 1024")));
}

TEST_F(BadGltfTest, ASceneOfChildrenOrOfTheSameNodeTwice) {
  model.document["nodes"] = json::parse(R"([{"children": [1]}, {"mesh": 0}])");
  model.document["scenes"] = {{{"nodes", {1}}}};
  EXPECT_THAT(refused(), AllOf(HasSubstr("/scenes/0/nodes"), HasSubstr("a child of node 0")));
  model.document["scenes"] = {{{"nodes", {0, 0}}}};
  EXPECT_THAT(refused(), HasSubstr("node 0 twice"));
}

TEST_F(BadGltfTest, TransformsThatOverflowOrTurnNowhere) {
  model.document["nodes"][0]["scale"] = {1e29, 1, 1};
  EXPECT_THAT(refused(),
              AllOf(HasSubstr("/meshes/0/primitives/0"), HasSubstr("vertex 1"), HasSubstr("/nodes/0")));
  model.document["nodes"][0]["scale"] = {1e200, 1, 1};
  EXPECT_THAT(refused(), HasSubstr("/nodes/0/scale"));
  model.document["nodes"][0] = {{"mesh", 0}, {"rotation", {0, 0, 0, 0}}};
  EXPECT_THAT(refused(), AllOf(HasSubstr("/nodes/0/rotation"), HasSubstr("a unit quaternion")));
}

TEST_F(BadGltfTest, InstancingBombs) {
  const std::vector<float> many(3 * 4096, 0.5f);
  model.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
      model.accessor<float>("VEC3", many);
  std::vector<std::uint32_t> indices(3 * 4096);
  for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint32_t>(i % 4096);
  primitive()["indices"] = model.accessor<std::uint32_t>("SCALAR", indices);
  json& nodes = model.document["nodes"] = json::array();
  for (int i = 0; i < 20000; ++i) nodes.push_back({{"mesh", 0}});
  EXPECT_THAT(refused(), AllOf(HasSubstr("/meshes/0/primitives/0"), HasSubstr("245760000 vertices"),
                               HasSubstr("20000 nodes")));
}

TEST_F(BadGltfTest, EveryIndexOutOfRange) {
  wear("image.png");
  folder.write("image.png", decode_base64(kPngGrey));
  model.document["samplers"] = json::array({json::object()});
  model.document["scenes"] = {{{"nodes", {0}}}};
  model.document["cameras"] =
      json::parse(R"([{"type": "perspective", "perspective": {"yfov": 1, "znear": 1}}])");
  model.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  model.document["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0;
  model.document["nodes"][0]["camera"] = 0;
  accessor()["sparse"] = {{"count", 1},
                          {"indices", {{"bufferView", 0}, {"componentType", 5125}}},
                          {"values", {{"bufferView", 0}}}};
  primitive()["indices"] = model.accessor<std::uint8_t>("SCALAR", {0, 1, 2});
  ASSERT_EQ(load_scene(model.write(folder)).triangles.size(), 1u);
  const json sound = model.document;
  for (const char* place : {"/scene",
                            "/scenes/0/nodes/0",
                            "/nodes/0/children/0",
                            "/nodes/0/mesh",
                            "/nodes/0/camera",
                            "/nodes/0/skin",
                            "/nodes/0/extensions/KHR_lights_punctual/light",
                            "/meshes/0/primitives/0/indices",
                            "/meshes/0/primitives/0/material",
                            "/meshes/0/primitives/0/attributes/POSITION",
                            "/meshes/0/primitives/0/targets/0/POSITION",
                            "/accessors/0/bufferView",
                            "/accessors/0/sparse/indices/bufferView",
                            "/accessors/0/sparse/values/bufferView",
                            "/bufferViews/0/buffer",
                            "/materials/0/pbrMetallicRoughness/baseColorTexture/index",
                            "/materials/0/emissiveTexture/index",
                            "/textures/0/source",
                            "/textures/0/sampler",
                            "/images/0/bufferView"}) {
    for (const json& bad : {json(1000), json(-1), json(4294967296), json(1.5), json("0")}) {
      model.document = sound;
      json::json_pointer pointer(place);
      if (pointer.back() == "0") model.document[pointer.parent_pointer()] = json::array();
      model.document[pointer] = bad;
      const std::string message = refusal(model.write(folder));
      EXPECT_THAT(message,
                  AllOf(HasSubstr(std::string(place) + ": found " + bad.dump()), HasSubstr("allowed: ")));
    }
  }
}

TEST_F(BadGltfTest, VertexIndicesOutOfRange) {
  primitive()["indices"] = model.accessor<std::uint16_t>("SCALAR", {0, 1, 3});
  EXPECT_THAT(refused(),
              AllOf(HasSubstr("/meshes/0/primitives/0"), HasSubstr("index 3 at 2"), HasSubstr("0 to 2")));
  primitive()["indices"] = model.accessor<std::uint32_t>("SCALAR", {0, 1, 0xffffffffu});
  EXPECT_THAT(refused(), HasSubstr("index 4294967295 at 2"));
}

TEST_F(BadGltfTest, IndicesThatAreNoUnsignedScalars) {
  primitive()["indices"] = model.accessor<float>("SCALAR", {0, 1, 2});
  EXPECT_THAT(refused(), AllOf(HasSubstr("/accessors/1"), HasSubstr("5121")));
  primitive()["indices"] = model.accessor<std::uint8_t>("VEC3", {0, 1, 2});
  EXPECT_THAT(refused(), HasSubstr("/accessors/2"));
  model.document["accessors"][2].erase("bufferView");
  EXPECT_THAT(refused(),
              AllOf(HasSubstr("/meshes/0/primitives/0/indices"), HasSubstr("without a bufferView")));
}

TEST_F(BadGltfTest, CornerCountsThatMakeNoTriangles) {
  primitive()["indices"] = model.accessor<std::uint8_t>("SCALAR", {0, 1, 2, 0});
  EXPECT_THAT(refused(),
              AllOf(HasSubstr("/meshes/0/primitives/0"), HasSubstr("4 corners"), HasSubstr("multiple of 3")));
}

TEST_F(BadGltfTest, AccessorsOutsideTheirViews) {
  accessor()["count"] = 4;
  EXPECT_THAT(refused(), AllOf(HasSubstr("/accessors/0"), HasSubstr("up to byte 48"),
                               HasSubstr("36 bytes of /bufferViews/0")));
  accessor()["count"] = 3;
  accessor()["byteOffset"] = 4;
  EXPECT_THAT(refused(), HasSubstr("up to byte 40"));
}

TEST_F(BadGltfTest, CountsAndOffsetsThatOverflow) {
  for (const std::uint64_t count : {0xffffffffull, 0x1555555555555556ull, 0xffffffffffffffffull, 0ull}) {
    accessor()["count"] = count;
    EXPECT_THAT(refused(), AllOf(HasSubstr("/accessors/0"), HasSubstr(std::to_string(count))));
  }
  accessor()["count"] = 3;
  for (const std::uint64_t offset : {0xffffffffull, 0xfffffffffffffffcull}) {
    accessor()["byteOffset"] = offset;
    EXPECT_THAT(refused(), HasSubstr("/accessors/0"));
  }
  accessor()["byteOffset"] = -12;
  EXPECT_THAT(refused(), AllOf(HasSubstr("/accessors/0/byteOffset"), HasSubstr("-12")));
}

TEST_F(BadGltfTest, ACountWithoutDataIsBoundedToo) {
  accessor().erase("bufferView");
  accessor()["count"] = 3000000000u;  // zeros, 36 GB of them
  EXPECT_THAT(refused(), AllOf(HasSubstr("/meshes/0/primitives/0"), HasSubstr("1000000000 more triangles")));
}

TEST_F(BadGltfTest, StridesThatMakeNoSense) {
  json& stride = model.document["bufferViews"][0]["byteStride"];
  stride = 8;
  EXPECT_THAT(refused(), AllOf(HasSubstr("/accessors/0"), HasSubstr("12 bytes"), HasSubstr("byteStride 8")));
  for (const int bad : {0, 3, 14, 256, -4}) {
    stride = bad;
    EXPECT_THAT(refused(), AllOf(HasSubstr("/bufferViews/0/byteStride"), HasSubstr(std::to_string(bad))));
  }
  stride = 16;  // in range, but the last element ends outside
  EXPECT_THAT(refused(), HasSubstr("up to byte 44"));
}

TEST_F(BadGltfTest, ViewsOutsideTheirBuffers) {
  model.document["bufferViews"][0]["byteLength"] = 40;
  EXPECT_THAT(refused(),
              AllOf(HasSubstr("/bufferViews/0"), HasSubstr("bytes up to 40"), HasSubstr("36 of /buffers/0")));
  model.document["bufferViews"][0]["byteOffset"] = 4294967295u;
  EXPECT_THAT(refused(), HasSubstr("bytes up to 4294967335"));
}

TEST_F(BadGltfTest, BuffersShorterThanTheySay) {
  model.finish("model.bin");
  model.document["buffers"][0]["byteLength"] = 1000;
  folder.write("model.bin", model.binary);
  EXPECT_THAT(refusal(folder.write("model.gltf", model.document.dump())),
              AllOf(HasSubstr("/buffers/0/byteLength"), HasSubstr("1000"), HasSubstr("36 bytes")));
  model.document["buffers"][0]["uri"] = "data:application/octet-stream;base64,!!!!";
  EXPECT_THAT(refusal(folder.write("model.gltf", model.document.dump())), HasSubstr("/buffers/0/uri"));
  model.document["buffers"][0].erase("uri");
  EXPECT_THAT(refusal(folder.write("model.gltf", model.document.dump())),
              AllOf(HasSubstr("/buffers/0"), HasSubstr("no uri")));
}

TEST_F(BadGltfTest, BuffersBeyondTheBound) {
  model.finish("model.bin");
  model.document["buffers"][0]["byteLength"] = 1ull << 40;
  EXPECT_THAT(refusal(folder.write("model.gltf", model.document.dump())),
              AllOf(HasSubstr("/buffers/0/byteLength"), HasSubstr("1099511627776")));
}

TEST_F(BadGltfTest, SparseIndicesOutOfOrderOrRange) {
  accessor()["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", model.view(bytes_of<std::uint16_t>({0, 3}))}, {"componentType", 5123}}},
      {"values", {{"bufferView", model.view(bytes_of<float>({0, 0, 0, 0, 0, 0}))}}}};
  EXPECT_THAT(refused(), AllOf(HasSubstr("/accessors/0/sparse/indices"), HasSubstr("index 3 at 1"),
                               HasSubstr("below 3")));
  accessor()["sparse"]["indices"]["bufferView"] = model.view(bytes_of<std::uint16_t>({2, 1}));
  EXPECT_THAT(refused(), HasSubstr("index 1 at 1"));
  accessor()["sparse"]["count"] = 4;
  EXPECT_THAT(refused(), AllOf(HasSubstr("/accessors/0/sparse/count"), HasSubstr("found 4")));
  accessor()["sparse"]["count"] = 3;
  EXPECT_THAT(refused(), AllOf(HasSubstr("/accessors/0/sparse/indices"), HasSubstr("up to byte 6")));
}

TEST_F(BadGltfTest, AttributesThatDisagree) {
  primitive()["attributes"]["NORMAL"] = model.accessor<float>("VEC3", {0, 0, 1});
  EXPECT_THAT(refused(), AllOf(HasSubstr("/meshes/0/primitives/0/attributes/NORMAL"), HasSubstr("1 elements"),
                               HasSubstr("3")));
  primitive()["attributes"]["NORMAL"] = model.accessor<float>("VEC2", {0, 0, 1, 0, 0, 0});
  EXPECT_THAT(refused(), AllOf(HasSubstr("attributes/NORMAL"), HasSubstr("2 components"), HasSubstr("VEC3")));
  primitive()["attributes"] = json::object();
  EXPECT_THAT(refused(), AllOf(HasSubstr("/meshes/0/primitives/0"), HasSubstr("no attribute POSITION")));
}

TEST_F(BadGltfTest, NumbersThatAreNotFinite) {
  for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity()}) {
    std::memcpy(&model.binary[16], &bad, 4);  // y of vertex 1
    EXPECT_THAT(refused(), AllOf(HasSubstr("/meshes/0/primitives/0"), HasSubstr("POSITION of vertex 1"),
                                 HasSubstr(fmt::format("{}", bad)), HasSubstr("finite")));
  }
  const float zero = 0, nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(&model.binary[16], &zero, 4);
  primitive()["attributes"]["NORMAL"] = model.accessor<float>("VEC3", {0, 0, 1, 0, 0, 1, 0, nan, 1});
  EXPECT_THAT(refused(), HasSubstr("NORMAL of vertex 2"));
}

TEST_F(BadGltfTest, PositionsTooFarOut) {
  const float far = 1e8f;
  std::memcpy(&model.binary[12], &far, 4);
  EXPECT_THAT(refused(), AllOf(HasSubstr("vertex 1"), HasSubstr("(100000000, 0, 0) m"), HasSubstr("within")));
}

TEST_F(BadGltfTest, CamerasAndLightsOutOfRange) {
  model.document["cameras"] =
      json::parse(R"([{"type": "perspective", "perspective": {"yfov": 4, "znear": 1}}])");
  EXPECT_THAT(refused(), AllOf(HasSubstr("/cameras/0/perspective/yfov"), HasSubstr("found 4")));
  model.document["cameras"] = json::parse(R"([{"type": "perspective"}])");
  EXPECT_THAT(refused(), AllOf(HasSubstr("/cameras/0"), HasSubstr("no perspective")));
  model.document.erase("cameras");
  model.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}}};
  EXPECT_THAT(refused(), AllOf(HasSubstr("/extensions/KHR_lights_punctual/lights/0"), HasSubstr("no spot")));
  model.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "area"}}};
  EXPECT_THAT(refused(), AllOf(HasSubstr("lights/0/type"), HasSubstr("\"area\""),
                               HasSubstr("directional, spot, point")));
}

}  // namespace
}  // namespace clpv::test::bad_gltf_test
