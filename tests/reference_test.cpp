// clpv reference: what it writes, what it refuses, and that a refusal costs no time and leaves nothing behind.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "image/image_io.hpp"

namespace clpv {
namespace {

namespace fs = std::filesystem;

/// A floor of 4 x 4 m at y = 0, facing up (positions, then 16-bit indices), and without its mesh an empty room.
std::string floor_gltf(bool with_floor) {
  nlohmann::json gltf = {
      {"asset", {{"version", "2.0"}}},
      {"scenes", {{{"nodes", nlohmann::json::array()}}}},
      {"scene", 0},
  };
  if (!with_floor) return gltf.dump();
  gltf["scenes"][0]["nodes"] = {0};
  gltf["nodes"] = {{{"mesh", 0}}};
  gltf["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}};
  gltf["accessors"] = {{{"bufferView", 0},
                        {"componentType", 5126},
                        {"count", 4},
                        {"type", "VEC3"},
                        {"min", {-2, 0, -2}},
                        {"max", {2, 0, 2}}},
                       {{"bufferView", 1}, {"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}};
  gltf["bufferViews"] = {{{"buffer", 0}, {"byteLength", 48}},
                         {{"buffer", 0}, {"byteOffset", 48}, {"byteLength", 12}}};
  gltf["buffers"] = {{{"byteLength", 60},
                      {"uri",
                       "data:application/octet-stream;base64,"
                       "AAAAwAAAAAAAAADAAAAAwAAAAAAAAABAAAAAQAAAAAAAAABAAAAAQAAAAAAAAADAAAABAAIAAAACAAMA"}}};
  return gltf.dump();
}

nlohmann::json floor_scene() {
  return {{"model", "floor.gltf"},
          {"metres_per_unit", 1},
          {"cameras",
           {{{"name", "down"}, {"eye", {0, 1, 0}}, {"target", {0.01, 0, 0}}, {"vertical_fov_degrees", 90}}}},
          {"lights",
           {{{"name", "sun"}, {"kind", "directional"}, {"direction", {0, -1, 0}}, {"illuminance_lux", 2}}}}};
}

class ReferenceCommand : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(CLPV_TEST_DIR) / "reference" / info->name();
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    write("floor.gltf", floor_gltf(true));
    write("empty.gltf", floor_gltf(false));
    write("floor.json", floor_scene().dump());
  }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string talk() const {
    std::ifstream stream(folder_ / "err.txt");
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  int run(const std::string& scene, const std::string& arguments) const {
    const std::string command = std::string(CLPV_PROGRAM) + " reference " + file(scene) + " " + arguments +
                                " > " + file("out.txt") + " 2> " + file("err.txt");
    const int status = std::system(command.c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  fs::path folder_;
};

TEST_F(ReferenceCommand, WritesLayersMetadataAndStats) {
  ASSERT_EQ(run("floor.json", "--camera down --width 9 --height 5 --spp 4 --seed 7 --view full,depth -o " +
                                  file("a.exr") + " --stats " + file("a.json")),
            0)
      << talk();
  EXPECT_EQ(fs::file_size(folder_ / "out.txt"), 0u) << "stdout is for data";
  const Image image = read_image(file("a.exr"));
  const Image full = extract_layer(image, "full", "a.exr"), depth = extract_layer(image, "depth", "a.exr");
  const float albedo = 1;
  EXPECT_NEAR(full.at(4, 2, 0), albedo * 2 / 3.14159265f, 1e-5);
  EXPECT_NEAR(depth.at(4, 2, 0), 1, 1e-4);
  EXPECT_EQ(full.at(4, 2, 3), 1);
  EXPECT_EQ(image.metadata.at("seed"), "7");
  EXPECT_EQ(image.metadata.at("spp"), "4");
  EXPECT_EQ(image.metadata.at("camera"), "down");
  EXPECT_EQ(image.metadata.at("bounces"), "1");
  const nlohmann::json stats = nlohmann::json::parse(std::ifstream(file("a.json")));
  EXPECT_EQ(stats["schema"], 1);
  EXPECT_EQ(stats["spp"], 4);
  EXPECT_EQ(stats["noise"], 0) << "a lone floor sees no light";
  EXPECT_GT(stats["rays"], 45);
}

TEST_F(ReferenceCommand, SameSeedSameBytesWhateverTheThreads) {
  const std::string options = "--width 33 --height 21 --spp 3 --bounces all -o ";
  ASSERT_EQ(run("floor.json", "--threads 1 " + options + file("a.exr")), 0) << talk();
  ASSERT_EQ(run("floor.json", "--threads 2 " + options + file("b.exr")), 0) << talk();
  const auto bytes = [&](const char* name) {
    std::ifstream stream(file(name), std::ios::binary);
    return std::string{std::istreambuf_iterator<char>(stream), {}};
  };
  EXPECT_EQ(bytes("a.exr"), bytes("b.exr"));
}

TEST_F(ReferenceCommand, BackgroundHasNoAlpha) {
  nlohmann::json scene = floor_scene();
  scene["cameras"][0]["target"] = {0.01, 2, 0};
  write("up.json", scene.dump());
  ASSERT_EQ(run("up.json", "--width 4 --height 4 --spp 2 -o " + file("a.exr")), 0) << talk();
  for (const float value : read_image(file("a.exr")).pixels) EXPECT_EQ(value, 0);
}

TEST_F(ReferenceCommand, RefusesWithItsOwnExitCode) {
  const std::string out = " -o " + file("a.exr");
  EXPECT_EQ(run("floor.json", "--spp 0" + out), 2);
  EXPECT_EQ(run("floor.json", "--noise 0" + out), 2);
  EXPECT_EQ(run("floor.json", "--spp 4 --noise 0.1" + out), 2);
  EXPECT_EQ(run("floor.json", "--bounces 0" + out), 2);
  EXPECT_EQ(run("floor.json", "--bounces some" + out), 2);
  EXPECT_EQ(run("floor.json", "--width 0" + out), 2);
  EXPECT_EQ(run("floor.json", "--view fog" + out), 2);
  EXPECT_NE(talk().find("irradiance"), std::string::npos) << "names the views there are: " << talk();
  EXPECT_EQ(run("floor.json", "--camera none" + out), 2);
  EXPECT_EQ(run("floor.json", "-o " + file("a.png")), 2);
  EXPECT_EQ(run("floor.json", "-o " + file("nowhere/a.exr")), 1);
  EXPECT_EQ(run("floor.json", out + " --stats " + file("nowhere/a.json")), 1);
  EXPECT_EQ(run("absent.json", out), 3);
  EXPECT_FALSE(fs::exists(folder_ / "a.exr"));
}

TEST_F(ReferenceCommand, RefusesASceneWithoutLightOrSurface) {
  nlohmann::json scene = floor_scene();
  scene["lights"] = nlohmann::json::array();
  write("dark.json", scene.dump());
  EXPECT_EQ(run("dark.json", "-o " + file("a.exr")), 3);
  EXPECT_NE(talk().find("light"), std::string::npos) << talk();
  scene = floor_scene();
  scene["model"] = "empty.gltf";
  write("empty.json", scene.dump());
  EXPECT_EQ(run("empty.json", "-o " + file("a.exr")), 3);
  EXPECT_NE(talk().find("surface"), std::string::npos) << talk();
  EXPECT_FALSE(fs::exists(folder_ / "a.exr"));
}

}  // namespace
}  // namespace clpv
