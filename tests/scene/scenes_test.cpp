// SPDX-License-Identifier: MIT
// This project's scenes: their generators reproduce the committed files, which match their
// descriptions.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/emission.hpp"
#include "scene/load.hpp"
#include "tests/support/run_program.hpp"

namespace clpv::scenes_test {
namespace {

namespace fs = std::filesystem;

const fs::path kScenes = fs::path(CLPV_SOURCE_DIR) / "scenes";

class Generator : public testing::TestWithParam<const char*> {};

TEST_P(Generator, ReproducesTheCommittedFiles) {
  if (test::run("python3 -c 'import sys; sys.exit(sys.version_info < (3, 9))'").exit_code != 0) {
    GTEST_SKIP() << "python3 is not 3.9 or later (Debian: apt install python3)";
  }
  const std::string name = GetParam();
  const test::TemporaryFolder folder;
  const test::Outcome outcome =
      test::run("PYTHONDONTWRITEBYTECODE=1 python3 " +
                (kScenes / ("generate_" + name + ".py")).string() + " " + folder.path().string());
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  int files = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder.path())) {
    const fs::path file = entry.path().filename();
    if (file == ".clpv-output") continue;  // lists the files
    EXPECT_TRUE(test::read_file(entry.path()) == test::read_file(kScenes / file))
        << file << " differs from the committed one";
    ++files;
  }
  EXPECT_EQ(files, name == "atrium" ? 5 : 6) << "models and scene files";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Generator, testing::Values("atrium", "cornell"),
                         [](const auto& info) { return std::string(info.param); });

struct Card {
  const char* file;
  std::size_t triangles, lights;
  glm::vec3 size;  ///< [m]
  std::vector<std::string> cameras;
};

TEST(Scenes, MatchTheirDescriptions) {
  const Card cards[] = {
      {"atrium.json", 266672, 1, {30, 10, 14.15f}, {"nave", "curtains", "gallery"}},
      {"cornell.json", 48, 2, {0.716f, 0.7088f, 0.6392f}, {"front", "published", "red", "green"}},
      {"cornell_lamp.json", 56, 0, {0.716f, 0.7088f, 0.6392f}, {"front", "published"}},
      {"empty_room.json",
       28,
       2,
       {0.7128f, 0.7088f, 0.6392f},
       {"front", "published", "red", "green"}}};
  for (const Card& card : cards) {
    SCOPED_TRACE(card.file);
    const SceneData scene = load_scene(kScenes / card.file);
    EXPECT_EQ(scene.triangles.size(), card.triangles);
    EXPECT_EQ(scene.lights.size(), card.lights);
    EXPECT_LT(glm::length(scene.upper - scene.lower - card.size), 0.02f);
    std::vector<std::string> cameras;
    for (const SceneCamera& camera : scene.cameras) cameras.push_back(camera.name);
    EXPECT_EQ(cameras, card.cameras);
    EXPECT_THAT(scene.notes, ::testing::IsEmpty());
  }
  const SceneData lamp = load_scene(kScenes / "cornell_lamp.json");
  EXPECT_NEAR(max_emitted_flux(lamp, emissive_triangles(lamp), 1000), M_PI * 17.2 * 0.130 * 0.105,
              1e-4);
}

TEST(Scenes, TheLivingAtriumIsTheAtriumWithABallAndACurtainThatMove) {
  const SceneData still = load_scene(kScenes / "atrium.json"),
                  living = load_scene(kScenes / "atrium_living.json");
  ASSERT_EQ(living.moving.size(), 2u);
  EXPECT_EQ(living.triangles.size(), still.triangles.size() + living.moving.back().triangles);
  EXPECT_EQ(living.lower, still.lower);
  EXPECT_EQ(living.upper, still.upper);
}

}  // namespace
}  // namespace clpv::scenes_test
