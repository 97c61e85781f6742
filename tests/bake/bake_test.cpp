// SPDX-License-Identifier: MIT
// Baked probes: those inside walls, interrupted bakes, limits, the command and its files.
// probe_formats_test.cpp has the formats.
#include "bake/bake.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "bake/ktx2.hpp"
#include "cli/bake_parts.hpp"
#include "options/scene_options.hpp"
#include "pipeline/frame/frame.hpp"
#include "scene/load.hpp"
#include "support/interrupt.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/ktx2_reader.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/sphere_quadrature.hpp"
#include "tests/support/traced_scenes.hpp"

namespace clpv::bake_test {
using namespace bake;
using namespace test;
using ::testing::HasSubstr;

TEST(Bake, InvalidProbesAreFilledFromTheirNeighbours) {
  const ProbeFormat format = probe_format("ambient-cube-mean");
  const ProbeGrid grid{{5, 1, 1}, {0, 0, 0}, {4, 1, 1}};
  GridLight light;
  light.count = 6;
  for (int i = 0; i < 5; ++i) light.integrals.insert(light.integrals.end(), 6, glm::vec3(i));
  const auto first = [&](bool dilate, const std::vector<std::uint8_t>& valid = {1, 0, 0, 0, 1}) {
    const BakedProbes baked = encoded(format, light, 0, grid, valid, dilate);
    std::vector<float> red;
    for (std::size_t i = 0; i < 5; ++i) red.push_back(baked.coefficients[6 * i].x);
    return red;
  };
  EXPECT_THAT(first(true), ::testing::ElementsAre(0, 0, 2, 4, 4));
  EXPECT_THAT(first(true, {0, 1, 1, 1, 1}), ::testing::ElementsAre(1, 1, 2, 3, 4));
  EXPECT_THAT(first(false), ::testing::ElementsAre(0, 1, 2, 3, 4));
}

TEST(Bake, EncodingIsTheSameOnAnyThreadsAndEndsByAnInterrupt) {
  const ProbeFormat format = probe_format("zh3");
  const ProbeGrid grid{{20, 15, 2}, {0, 0, 0}, {4, 1, 1}};
  std::vector<std::uint8_t> valid(grid.size(), 0);
  for (std::size_t i = 0; i < valid.size(); i += 37) valid[i] = 1;
  GridLight light;
  light.count = format.moments.count;
  for (std::size_t i = 0; i < grid.size() * light.count; ++i)
    light.integrals.emplace_back(std::sin(i), 1, 2);
  const auto of = [&](int threads) {
    return encoded(format, light, 0, grid, valid, true, threads);
  };
  const BakedProbes one = of(1), several = of(3);
  EXPECT_EQ(one.coefficients, several.coefficients);
  EXPECT_EQ(one.negative, several.negative);
  const StopRequest stop{true};
  const StopScope scope(&stop);
  EXPECT_THROW(of(2), Interrupted);
}

// A block inside a room: probes in it see its faces' backs.
TEST(Bake, ProbesInsideWallsAreInvalid) {
  SceneData scene;
  scene.path = "room";
  add_grey(scene, 0.5f);
  add_box(scene, glm::vec3(0), 4, 0);
  for (int axis = 0; axis < 3; ++axis) {  // a block, its faces outwards
    glm::vec3 low(1), u(0), v(0), across(0);
    u[(axis + 1) % 3] = v[(axis + 2) % 3] = across[axis] = 1;
    add_quad(scene, low, v, u, 0);
    add_quad(scene, low + across, u, v, 0);
  }
  PathTracerOptions options;
  options.samples = 1;
  pathtracer::PointTracer tracer(scene, {}, options);
  const std::vector<glm::dvec3> positions{
      {1.5, 1.5, 1.5}, {1.1, 1.9, 1.5}, {3, 3, 3}, {0.9, 1.5, 1.5}, {-1, 2, 2}};
  EXPECT_THAT(validity(tracer, positions), ::testing::ElementsAre(0, 0, 1, 1, 0));
  const std::vector<glm::dvec3> on_walls{{0, 2, 2}, {4, 4, 4}, {1.5, 2, 1.5}};
  EXPECT_THAT(validity(tracer, on_walls), ::testing::Each(1));
  for (std::size_t i = scene.triangles.size() - 12; i < scene.triangles.size(); ++i)
    scene.triangles[i].material = 1;  // the block is of cloth
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].flags |= CLPV_MATERIAL_DOUBLE_SIDED;
  pathtracer::PointTracer other(scene, {}, options);
  EXPECT_THAT(validity(other, positions), ::testing::ElementsAre(1, 1, 1, 1, 0));
}

/// A source of numbered probes that is interrupted before block `end`.
class Counted : public ProbeSource {
 public:
  explicit Counted(std::size_t end) : end_(end) { blocks_ = {{0, 2}, {1}, {3}}; }
  BlockLight light(std::size_t block) override {
    if (block == end_) throw Interrupted("test");
    ++calls;
    BlockLight light;
    for (const std::size_t probe : blocks_[block])
      light.integrals.emplace_back(static_cast<float>(probe));
    light.samples = 7, light.noise = 0.5f;
    return light;
  }
  int calls = 0;

 private:
  std::size_t end_;
};

TEST(Bake, AnInterruptedBakeGoesOn) {
  const TemporaryFolder folder;
  std::filesystem::permissions(folder.path(), std::filesystem::perms::owner_all);
  const ProbeGrid grid{{4, 1, 1}, {0, 0, 0}, {3, 1, 1}};
  const auto bake = [&](Counted& source, const char* key = "key") {
    BlockCache cache(folder.path(), key);
    return light_of(source, grid, 1, cache, [](std::size_t) {});
  };
  Counted stopped(2), resumed(9), other(9);
  EXPECT_THROW(bake(stopped), Interrupted);
  EXPECT_TRUE(BlockCache(folder.path(), "key").keeps());
  EXPECT_FALSE(BlockCache(std::nullopt, "key").keeps());
  const GridLight all = bake(resumed);
  EXPECT_EQ(resumed.calls, 1) << "two blocks were kept";
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(all.integrals[i].x, i);
  EXPECT_EQ(all.samples, 7u);
  EXPECT_NEAR(all.noise, 0.5, 1e-6);
  bake(other, "other");
  EXPECT_EQ(other.calls, 3);
  BlockCache(folder.path(), "key").clear(3);
  EXPECT_FALSE(std::filesystem::exists(folder / "bakes/key-0.block"));
  EXPECT_TRUE(std::filesystem::exists(folder / "bakes/other-0.block"));
}

TEST(Bake, LightThatIsNotFiniteIsAnError) {
  struct Broken : ProbeSource {
    Broken() { blocks_ = {{0}}; }
    BlockLight light(std::size_t) override {
      return {{glm::vec3(0, std::numeric_limits<float>::quiet_NaN(), 0)}, 0, 1};
    }
  } source;
  const TemporaryFolder folder;
  const ProbeGrid grid{{1, 1, 1}, {0, 0, 0}, {1, 1, 1}};
  BlockCache cache(folder.path(), "key");
  EXPECT_THAT(
      error_of(ExitCode::run_time, [&] { light_of(source, grid, 1, cache, [](std::size_t) {}); }),
      HasSubstr("probe at (0.5, 0.5, 0.5): found light of 0, nan, 0"));
  EXPECT_FALSE(std::filesystem::exists(folder / "bakes/key-0.block"));
}

// Cells of the finest cascade are not larger than the spacing, and the coarsest reaches as far.
TEST(Bake, CascadesFitTheSpacing) {
  SceneData scene;
  scene.path = "scene.json";
  bake_command::Options options;
  const auto frame = [&](double spacing) {
    const ProbeGrid grid{{2, 2, 1}, {0, 0, 0}, {spacing, 2, 0.01}};
    return bake_command::frame_options(options, scene, grid);
  };
  EXPECT_EQ(frame(1).cascade_size, 12.5);
  EXPECT_EQ(frame(0.1).cascade_size, 12.5 / 4);
  EXPECT_EQ(frame(0.1).cascades, 5);
  EXPECT_EQ(frame(1e-4).cascades, kMaxCascades);
  options.request.frame["cascade-size"] = "25";
  EXPECT_EQ(frame(0.1).cascade_size, 25);
  scene.lower = glm::vec3(-1), scene.upper = glm::vec3(1);
  options.probes = "2,3,1";
  const ProbeGrid grid = bake_command::grid_of(options, scene, 9);
  EXPECT_EQ(grid.lower, glm::dvec3(-0.75, -0.875, -1)) << "an eighth inside";
  EXPECT_EQ(grid.upper, glm::dvec3(0.75, 0.875, 1));
  scene.lower = glm::vec3(-1, 0, -1), scene.upper = glm::vec3(1, 0, 1);
  EXPECT_THAT(error_of(ExitCode::usage, [&] { bake_command::grid_of(options, scene, 9); }),
              HasSubstr("the scene's box: found 0 to 0 along y"));
}

// Probes of a sweep have the irradiance of the frame's volumes, up to the order of mean and white
// furnace: a probe is made of radiances, each over the furnace's radiance; irradiance is over the
// furnace's irradiance. They differ by 0.034 where the brightest has 0.44.
TEST(Bake, SweptProbesHaveTheLightOfTheVolumes) {
  const SceneData scene = load_scene(kCornell);
  RenderOptions options = resolve_options({{"grid", "16"},
                                           {"directions", "24"},
                                           {"rsm-size", "64"},
                                           {"near", "off"},
                                           {"bounces", "1"},
                                           {"gather-offset", "0"},
                                           {"cascades", "1"}},
                                          scene);
  options.cascade_size = 1.6;
  const ProbeGrid grid{{2, 2, 2}, {0.1, 0.1, 0.05}, {0.45, 0.5, 0.2}};
  const ProbeFormat format = probe_format("sh3");
  Session& session = test_session();
  pathtracer::PointTracer tracer(scene, {}, {});
  const auto source =
      swept_light(session, scene, scene.camera(""), options, grid, {format}, tracer);
  ASSERT_EQ(source->blocks().size(), 1u);
  const BlockLight light = source->light(0);
  ASSERT_EQ(light.integrals.size(), 8 * 9u);
  Frame frame(session, scene, options);
  SceneCamera camera = scene.camera("");
  camera.eye = glm::vec3((grid.lower + grid.upper) / 2.0);
  frame.render(camera);
  const std::vector<glm::dvec3> places = tracer.off_surfaces(positions_of(grid), 0.05);
  int lit = 0;
  for (std::size_t probe = 0; probe < 8; ++probe) {
    std::vector<glm::dvec3> c;
    for (std::size_t i = 0; i < 9; ++i) c.emplace_back(light.integrals[9 * probe + i]);
    for (const glm::dvec3& n : {glm::dvec3(0, 1, 0), {1, 0, 0}, {0, -1, 0}, {0, 0, -1}}) {
      const auto e = frame.irradiance_at({glm::vec4(places[probe], 0)}, {glm::vec4(n, 0)});
      const glm::dvec3 found = glm::max(format.irradiance(c, n), 0.0);
      EXPECT_NEAR(found.x, e[0].x, 0.04);
      lit += e[0].x > 0.05;
    }
  }
  EXPECT_GT(lit, 8);
  EXPECT_THAT(error_of(ExitCode::usage,
                       [&] {
                         RenderOptions tiny = options;
                         tiny.cascade_size = 0.01;
                         swept_light(session, scene, scene.camera(""), tiny, grid, {format},
                                     tracer);
                       }),
              testing::AllOf(HasSubstr("frames of cascades of 0.01 m"), HasSubstr("4096")));
}

struct BakeCommand : ::testing::Test {
  TemporaryFolder folder;
  Outcome bake(const std::string& arguments) {
    return run_here("bake " + kCornell + " " + arguments, folder.path());
  }
  nlohmann::json description(const std::string& file) {
    return nlohmann::json::parse(test::read_file(folder / (file + ".json")));
  }
};

// Files of both engines show the truth at points in the air of the Cornell box.
TEST_F(BakeCommand, FilesShowTheTruth) {
  const std::string traced =
      "--from pathtrace --spp 64 --probes 7,7,7 --bounds 0.03,0.03,0.03,0.52,0.52,0.52 ";
  for (const char* file : {"a.ktx2 --format ambient-cube", "b.ktx2 --format sh3"}) {
    const Outcome outcome = bake(traced + "-o " + file);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  }
  const nlohmann::json cube = description("a.ktx2"), atlas = description("b.ktx2");
  EXPECT_EQ(cube["intensity"], 1);
  EXPECT_GT(cube["invalid"], 10);
  EXPECT_EQ(cube["invalid"], atlas["invalid"]);
  EXPECT_EQ(cube["spp"], 64);
  const ReadTexture bevy = read_ktx2(test::read_file(folder / "a.ktx2")),
                    three = read_ktx2(test::read_file(folder / "b.ktx2"));
  const auto vector_of = [](const nlohmann::json& v) {
    return glm::dvec3(v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
  };
  const ProbeGrid grid{{7, 7, 7}, glm::dvec3(0.03), glm::dvec3(0.52)};
  const SceneData scene = load_scene(kCornell);
  PathTracerOptions options;
  options.samples = 64, options.bounces = PathTracerOptions::kAllBounces;
  pathtracer::PointTracer tracer(scene, scene.lights_for(scene.camera("")), options);
  double noise = 0, squares[2] = {}, all = 0;
  const CheckPoints points = air_points(tracer, grid, 100, false, noise);
  ASSERT_EQ(points.points.size(), 600u);
  for (std::size_t i = 0; i < points.points.size(); ++i) {
    const auto& [position, n] = points.points[i];
    const glm::dvec3 truth = points.truth[i];
    const glm::dvec3 found[] = {
        std::numbers::pi * bevy_light(bevy, vector_of(cube["bevy"]["translation"]),
                                      vector_of(cube["bevy"]["scale"]), position, n),
        three_light(three, vector_of(atlas["bounds"][0]), vector_of(atlas["bounds"][1]),
                    position - 0.5 * grid.spacing() * n, n)};
    for (int k = 0; k < 2; ++k) squares[k] += glm::dot(found[k] - truth, found[k] - truth);
    all += glm::dot(truth, truth);
  }
  EXPECT_FALSE(cube.contains("error"));
  const Outcome checked = bake(traced + "--check 100");
  ASSERT_EQ(checked.exit_code, 0) << checked.err;
  std::map<std::string, double> printed;  // error in the air [%]
  std::istringstream rows(checked.out);
  for (std::string row; std::getline(rows, row);) {
    std::istringstream words(row);
    std::string name, number;
    words >> name;
    for (int column = 0; column < 5; ++column) words >> number;
    printed[name] = std::atof(number.c_str());
  }
  for (const std::string& name : probe_format_names()) EXPECT_GT(printed[name], 5) << name;
  EXPECT_NEAR(100 * std::sqrt(squares[0] / all), printed["ambient-cube"], 0.3)
      << "Bevy shows negative light, which the rows count as 0";
  EXPECT_NEAR(100 * std::sqrt(squares[1] / all), printed["sh3"], 0.1);
  EXPECT_LT(printed["sh3"], 40);
  const Outcome with_file = bake(traced + "-o c.npz --format sh3 --check 100");
  ASSERT_EQ(with_file.exit_code, 0) << with_file.err;
  const nlohmann::json error = description("c.npz")["error"];
  EXPECT_NEAR(100 * error["air"]["nrmse"].get<double>(), printed["sh3"], 0.051);
  EXPECT_EQ(error["surfaces"]["points"], 100);
  EXPECT_EQ(with_file.out.find("bins24"), std::string::npos);
}

// Mitsuba 3's irradiance meters have 0.820 and 0.675 there (docs/bake.md).
TEST_F(BakeCommand, MeanLightAtGivenPoints) {
  std::ofstream(folder / "points.csv") << "0.28,0.27,0.1,0,0,1\n0.1,0.1,0.1,0,1,0\n";
  std::ofstream(folder / "none.csv") << "# x,y,z,nx,ny,nz\n";
  const Outcome outcome =
      bake("--from pathtrace --bounces 1 --spp 512 --probes 5,5,5 --points points.csv");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  std::istringstream rows(outcome.out);
  std::map<std::string, double> mean;
  for (std::string row, name; std::getline(rows, row);) {
    std::istringstream words(row);
    words >> name;
    if (name != "truth" && words >> row) words >> row;
    words >> mean[name];
  }
  EXPECT_NEAR(mean["truth"], 0.7475, 0.03);
  EXPECT_NEAR(mean["sh3"], mean["truth"], 0.3);
  EXPECT_EQ(mean.size(), probe_format_names().size() + 2);
  EXPECT_THAT(outcome.err, ::testing::Not(HasSubstr("outside")));
  EXPECT_EQ(bake("--probes 5,5,5 --points points.csv --check 3").exit_code, 2);
  EXPECT_EQ(bake("--probes 5,5,5 --points none.csv").exit_code, 3);
  std::ofstream(folder / "far.csv") << "0,0.3,0.3,1,0,0\n-0.3,0.3,0.3,1,0,0\n0.3,5,0.3,0,1,0\n";
  EXPECT_THAT(bake("--from pathtrace --spp 1 --probes 6,6,6 --points far.csv").err,
              HasSubstr("2 of 3 points lie more than half a spacing outside the probes"));
}

TEST_F(BakeCommand, OfASweepInAnArchive) {
  const std::string small = kSweepOfOne + "--rsm-size 64 --cascade-size 1.6 --gather-offset 0 ";
  const Outcome outcome = bake(small + "--probes 3,4,5 --format zh3 --no-dilate -o a.npz");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  const nlohmann::json json = description("a.npz");
  EXPECT_EQ(json["probes"], nlohmann::json({3, 4, 5}));
  EXPECT_EQ(json["format"], "zh3");
  EXPECT_EQ(json["dilated"], false);
  const Outcome read = run(
      "/usr/bin/python3 -c \"import numpy as n; a = n.load('" + (folder / "a.npz").string() +
      "'); print(*(f'{k}:{a[k].shape}' for k in a), a['format'], (a['coefficients'] > 0).any(), "
      "n.allclose(a['position'][4, 3, 2], a['bounds'][1]))\"");
  if (read.exit_code != 0 && read.err.find("No module") != std::string::npos)
    GTEST_SKIP() << "NumPy is not installed (Debian: apt install python3-numpy)";
  EXPECT_EQ(read.out,
            "position:(5, 4, 3, 3) coefficients:(5, 4, 3, 5, 3) validity:(5, 4, 3) bounds:(2, 3) "
            "spacing:(3,) format:() meaning:() zh3 True True\n");
}

TEST_F(BakeCommand, BadInputIsNamedBeforeTheWork) {
  const std::pair<const char*, const char*> bad[] = {
      {"-o a.png", ".ktx2"},
      {"", "none of --output, --check and --points"},
      {"-o a.npz --format sh7", "'sh7'"},
      {"-o a.npz --bounds 0,0,0,1,1", "six numbers"},
      {"-o a.npz --bounds 0,0,0,1,-1,1", "found 0 to -1 along y"},
      {"-o a.npz --spacing 0", "--spacing"},
      {"-o a.npz --spacing 1e-6", "allowed: at most 4194304 probes"},
      {"-o a.npz --probes 1000,1000,1000", "1000 x 1000 x 1000"},
      {"-o a.npz --probes 0,1,1", "1 or more"},
      {"-o a.npz --probes 4,4", "three numbers"},
      {"-o a.npz --probes 4,4,4 --spacing 1", "one of them"},
      {"-o a.ktx2 --probes 2,1025,2", "a texture of 2 x 2050 x 6"},
      {"-o a.ktx2 --probes 2,2,1 --format sh3", "found 1 along z"},
      {"-o a.ktx2 --format zh3", "for a .ktx2"},
      {"-o a.npz --transport sampled", "sweep"},
      {"-o a.npz --from pathtrace --grid 16", "--grid has no effect"},
      {"-o a.npz --spp 4", "--spp has no effect with --from sweep"}};
  for (const auto& [arguments, message] : bad) {
    const Outcome outcome = bake(arguments);
    EXPECT_EQ(outcome.exit_code, 2) << arguments;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << arguments;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace clpv::bake_test
