// SPDX-License-Identifier: MIT
// Hostile models and scene files as the program meets them. bad_gltf_test.cpp and its like have each rule of the loader, in
// its process; here is that a user is told, and how the program ends.
#include "tests/support/gltf_builder.hpp"
#include "tests/support/hostile.hpp"

namespace clpv::test::hostile_scene_test {
namespace {

/// A sound model with one thing changed: the value at that JSON pointer.
std::string model_with(const std::string& pointer, const json& value) {
  GltfBuilder model;
  model.triangle();
  model.finish("data:application/octet-stream;base64," + encode_base64(model.binary));
  model.document[json::json_pointer(pointer)] = value;
  return model.document.dump();
}

HostileInput model(const std::string& name, const std::string& bytes, std::vector<std::string> words,
                   const std::string& file = "model.gltf") {
  words.push_back(file);
  return {name, "render @/" + file + " -o @/out.exr", 3, std::move(words), {{file, bytes}}};
}

/// A .glb of those lengths (as its header says) and chunks.
std::string glb(std::uint32_t version, std::uint32_t length, const std::string& chunks) {
  return "glTF" + bytes_of<std::uint32_t>({version, length}) + chunks;
}

std::string chunk(std::uint32_t size, const char* type, const std::string& bytes) {
  return bytes_of<std::uint32_t>({size}) + std::string(type, 4) + bytes;
}

TEST(HostileScenes, Models) {
  expect_all_refused(
      {
          model("nothing", "", {"no JSON"}),
          model("a blank", " ", {"no JSON"}),
          model("zeros", std::string(4096, '\0'), {"no JSON"}),
          model("a picture", "\x89PNG\r\n\x1a\n", {"no JSON"}),
          model("a page", "<html><body>404</body></html>", {"no JSON"}),
          model("text in UTF-16", std::string("\xff\xfe{\0}\0", 6), {"no JSON"}),
          model("text that is not UTF-8", "{\"asset\": {\"version\": \"2.0\xff\"}}", {"no JSON", "UTF-8"}),
          model("brackets without end", std::string(100000, '['), {"nested"}),
          model("objects without end",
                [] {
                  std::string text;
                  for (int i = 0; i < 20000; ++i) text += "{\"a\":";
                  return text;
                }(),
                {"nested"}),
          model("half a document", model_with("/scene", 0).substr(0, 120), {"no JSON"}),
          model("two documents", "{}{}", {"no JSON"}),
          model("a number too large for any", R"({"asset": {"version": "2.0"}, "scene": 1e999})",
                {"no JSON"}),
          model("a list", "[]", {"an object"}),
          model("a text", "\"glTF\"", {"an object"}),
          model("nothing in braces", "{}", {"/asset"}),
          model("an older version", R"({"asset": {"version": "1.0"}})", {"/asset/version", "'1.0'"}),
          model("a version that is none", R"({"asset": {"version": 2}})", {"/asset/version"}),
          model("an extension that must be known",
                model_with("/extensionsRequired", {"KHR_draco_mesh_compression"}),
                {"/extensionsRequired/0", "KHR_draco_mesh_compression"}),
          model("an extension that clears the screen",
                model_with("/extensionsRequired", {"\x1b[2J\xc2\x9b"
                                                   "0m"}),
                {"'?[2J?0m'"}),
          model("a scene that is not there", model_with("/scene", 5), {"/scene", "found 5"}),
          model("a node of itself", model_with("/nodes/0/children", {0}), {"a cycle"}),
          model("a mesh below none", model_with("/nodes/0/mesh", -1), {"/nodes/0/mesh", "-1"}),
          model("a mesh of 2^64", model_with("/nodes/0/mesh", 18446744073709551615ull), {"/nodes/0/mesh"}),
          model("a scale of nothing finite", model_with("/nodes/0/scale", {1e300, 1, 1}), {"/nodes/0/scale"}),
          model("a turn of no length", model_with("/nodes/0/rotation", {0, 0, 0, 0}), {"/nodes/0/rotation"}),
          model("a matrix of 15", model_with("/nodes/0/matrix", std::vector<int>(15, 1)),
                {"/nodes/0/matrix"}),
          model("primitives of nothing", model_with("/meshes/0/primitives", json::array()),
                {"/meshes/0/primitives"}),
          model("positions that are not there",
                model_with("/meshes/0/primitives/0/attributes", json::object()), {"POSITION"}),
          model("triangles of two corners", model_with("/accessors/0/count", 2), {"/meshes/0/primitives/0"}),
          model("no corners", model_with("/accessors/0/count", 0), {"/accessors/0/count"}),
          model("corners without end", model_with("/accessors/0/count", 4294967295u), {"/accessors/0"}),
          model(
              "corners without bytes",
              model_with("/accessors/0", {{"componentType", 5126}, {"count", 3000000000u}, {"type", "VEC3"}}),
              {"/meshes/0/primitives/0", "1000000000 more triangles"}),
          model("a type of no name", model_with("/accessors/0/type", "VEC5"), {"/accessors/0/type", "VEC5"}),
          model("components of no type", model_with("/accessors/0/componentType", 5130),
                {"/accessors/0/componentType"}),
          model("a view past its buffer", model_with("/bufferViews/0/byteLength", 4096), {"/bufferViews/0"}),
          model("a view at the end of the world", model_with("/bufferViews/0/byteOffset", 4294967295u),
                {"/bufferViews/0"}),
          model("a stride of one", model_with("/bufferViews/0/byteStride", 1), {"/bufferViews/0/byteStride"}),
          model("a buffer too large", model_with("/buffers/0/byteLength", 1ull << 40),
                {"/buffers/0/byteLength"}),
          model("a buffer of a web", model_with("/buffers/0/uri", "https://example.org/a.bin"),
                {"/buffers/0/uri"}),
          model("a buffer of another's", model_with("/buffers/0/uri", "../../../../etc/passwd"),
                {"/buffers/0/uri", "leaves"}),
          model("a buffer by an absolute path", model_with("/buffers/0/uri", "/etc/passwd"),
                {"/buffers/0/uri"}),
          model("a buffer that is a folder", model_with("/buffers/0/uri", "."), {"/buffers/0/uri"}),
          model("a buffer that is the model",
                model_with("/buffers/0", {{"byteLength", 1u << 20}, {"uri", "model.gltf"}}), {"/buffers/0"}),
          model("base64 that is none",
                model_with("/buffers/0/uri", "data:application/octet-stream;base64,!!"), {"/buffers/0/uri"}),
          model(
              "a field of view of a circle",
              model_with("/cameras",
                         json::parse(R"([{"type": "perspective", "perspective": {"yfov": 7, "znear": 1}}])")),
              {"/cameras/0/perspective/yfov"}),
          model("a light of no kind",
                model_with("/extensions/KHR_lights_punctual/lights", {{{"type", "laser"}}}),
                {"lights/0/type", "laser"}),
          model("a header alone", glb(2, 12, ""), {"truncated"}, "model.glb"),
          model("an older container", glb(1, 28, chunk(8, "JSON", "{}      ")), {"version 1"}, "model.glb"),
          model("a container longer than it is", glb(2, 4000, chunk(8, "JSON", "{}      ")), {"4000"},
                "model.glb"),
          model("a chunk longer than all", glb(2, 28, chunk(4294967292u, "JSON", "{}      ")), {"chunk"},
                "model.glb"),
          model("a container of bytes first", glb(2, 28, chunk(8, "BIN\0", "{}      ")), {"first .glb chunk"},
                "model.glb"),
          {"a model that is not there", "render @/none.gltf -o @/out.exr", 3, {"none.gltf", "no file"}},
          {"a model of another kind",
           "render @/a.obj -o @/out.exr",
           3,
           {"'.obj'", ".gltf"},
           {{"a.obj", "v 0 0 0"}}},
          {"a folder for a model", "render @/a.gltf -o @/out.exr", 3, {"a folder"}, {{"a.gltf/b", ""}}},
      },
      53);
}

HostileInput scene(const std::string& name, const std::string& text, std::vector<std::string> words) {
  words.push_back("scene.json");
  return {name,
          "reference @/scene.json -o @/out.exr",
          3,
          std::move(words),
          {{"scene.json", text}, {"model.gltf", model_with("/scenes", {{{"nodes", {0}}}})}}};
}

std::string camera(const std::string& text) {
  return R"({"model": "model.gltf", "cameras": [{"name": "a", "eye": [0, 0, 0], "target": [1, 0, 0], )" +
         text + "}]}";
}

std::string light(const std::string& text) {
  return R"({"model": "model.gltf", "lights": [)" + text + "]}";
}

TEST(HostileScenes, SceneFiles) {
  const std::string sun = R"({"kind": "directional", "direction": [0, -1, 0], "illuminance_lux": )";
  expect_all_refused(
      {
          scene("nothing", "", {"no JSON"}),
          scene("no model", "{}", {"/model"}),
          scene("a model that is not there", R"({"model": "absent.gltf"})", {"/model", "absent.gltf"}),
          scene("a model that is a number", R"({"model": 7})", {"/model", "found 7"}),
          scene("itself for a model", R"({"model": "scene.json"})", {"/asset"}),
          scene("a key of no meaning", R"({"model": "model.gltf", "colour": 1})", {"/colour", "unknown key"}),
          scene("a unit of none", R"({"model": "model.gltf", "metres_per_unit": 0})", {"/metres_per_unit"}),
          scene("a unit below none", R"({"model": "model.gltf", "metres_per_unit": -1})",
                {"/metres_per_unit"}),
          scene("an exposure beyond all", R"({"model": "model.gltf", "exposure": 100})",
                {"/exposure", "-64 to 64"}),
          scene("cascades by halves", R"({"model": "model.gltf", "cascades": {"count": 1.5}})",
                {"/cascades/count"}),
          scene("cascades without end", R"({"model": "model.gltf", "cascades": {"count": 17}})",
                {"/cascades/count"}),
          scene("a field of view of none", camera(R"("vertical_fov_degrees": 0)"),
                {"/cameras/0/vertical_fov_degrees"}),
          scene("a field of view of all", camera(R"("vertical_fov_degrees": 180)"),
                {"/cameras/0/vertical_fov_degrees"}),
          scene("nothing near", camera(R"("near": 0)"), {"/cameras/0/near"}),
          scene("up along the view", camera(R"("up": [1, 0, 0])"), {"/cameras/0/up"}),
          scene("up to nowhere", camera(R"("up": [0, 0, 0])"), {"/cameras/0/up", "no length"}),
          scene("a moon that is not there", camera(R"("light": "moon")"), {"/cameras/0/light", "'moon'"}),
          scene("a light of no kind", light(R"({"kind": "laser"})"),
                {"/lights/0/kind", "directional, spot, point"}),
          scene("a light to nowhere",
                light(R"({"kind": "directional", "direction": [0, 0, 0], "illuminance_lux": 1})"),
                {"/lights/0/direction", "no length"}),
          scene("a sun below none", light(sun + "-1}"), {"/lights/0/illuminance_lux"}),
          scene("a sun above all", light(sun + "1e30}"), {"/lights/0/illuminance_lux"}),
          scene("a sun in words", light(sun + "\"bright\"}"), {"/lights/0/illuminance_lux", "\"bright\""}),
          scene(
              "a cone inside out",
              light(R"({"kind": "spot", "position": [0, 0, 0], "direction": [0, 0, 1], "intensity_candela": 1,
                        "inner_cone_degrees": 50, "outer_cone_degrees": 40})"),
              {"/lights/0", "inner less than outer"}),
          scene("65 lights", light([&] {
                  std::string all = sun + "1}";
                  for (int i = 0; i < 64; ++i) all += ", " + sun + "1}";
                  return all;
                }()),
                {"/lights", "an array of 65"}),
          scene("a name of control characters", camera("\"name\": \"\\u001b[31m\", \"light\": \"\\u0000\""),
                {"/cameras/0"}),
      },
      25);
}

}  // namespace
}  // namespace clpv::test::hostile_scene_test
