// SPDX-License-Identifier: MIT
// Light at points: irradiance equals the frame's at visible points, radiance the CPU reference's;
// valid and invalid files of points; `clpv query`.

#include <cstdlib>

#include "pipeline/frame/cascade.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/raster/view.hpp"
#include "pipeline/voxels/voxel_field.hpp"
#include "reference/cascade_sample.hpp"
#include "reference/view.hpp"
#include "scene/input.hpp"
#include "scene/load.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/run_here.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::test::query_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

RenderOptions small_options(const SceneData& scene) {
  RenderOptions options = small_sweep();
  options.width = 48;
  options.height = 27;
  options.rsm_size = 64;
  options.near = Near::off;  // points have none
  options.cascade_size = scene.cascade_size.value_or(options.cascade_size);
  return options;
}

glm::dvec3 even(std::uint32_t i) {
  const auto part = [i](double step) { return std::fmod(0.5 + step * i, 1.0); };
  return {part(0.8191725), part(0.6710436), part(0.5497005)};
}

TEST(RadianceAtPoints, IsThatOfTheReference) {
  const SceneData scene = load_scene(kCornell);
  for (const Gathering gather : {Gathering::visible, Gathering::all}) {
    RenderOptions options = small_options(scene);
    options.cascades = 2, options.cascade_size = 0.5;  // the box reaches into the coarser one
    options.gather = gather;
    options.layout = Layout::soa;
    Session& session = test_session();
    Frame frame(session, scene, options);
    frame.render(scene.camera(""));
    const GatheredLight light = frame.light();
    std::vector<reference::Volume> volumes;
    for (const Volume* volume : light.accumulated) {
      const std::vector<float> values = volume->read(session);
      volumes.emplace_back(options.grid, 9, 4);
      for (std::size_t i = 0; i < values.size(); ++i)
        volumes.back().values[i] =
            double{values[i]} / (i < values.size() / 4 * 3 ? light.scale : 1);
    }
    const std::size_t bytes = visibility_bytes(options.grid);
    std::vector<std::uint8_t> occluded;
    if (light.occluded.exists()) occluded = session.read<std::uint8_t>(light.occluded, 2 * bytes);
    std::vector<reference::Cascade> cascades;
    for (std::size_t c = 0; c < 2; ++c)
      cascades.push_back(
          {light.grids[c], &volumes[c], occluded.empty() ? nullptr : &occluded[c * bytes]});

    std::vector<glm::vec4> positions, directions;
    for (std::uint32_t i = 0; i < 2100; ++i) {  // more than two rows of the points' image
      positions.emplace_back(glm::vec3(0.02 + 0.52 * even(i)), 0);
      directions.emplace_back(glm::vec3(glm::normalize(even(7 * i + 3) - 0.5)), 0);
    }
    positions.back() = {900, 0, 0, 0};
    const std::vector<glm::vec4> found = frame.radiance_at(positions, directions);
    ASSERT_EQ(found.size(), positions.size());
    EXPECT_EQ(found.back(), glm::vec4(0)) << "outside the cascades";
    double brightest = 0, worst = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const auto field =
          reference::radiance_field(gather_options(options), cascades, 9, glm::dvec3(positions[i]));
      const glm::dvec3 expected =
          reference::radiance(frame.gathered(), field, glm::dvec3(directions[i]));
      brightest = std::max(brightest, expected.x);
      worst = std::max(worst, glm::length(glm::dvec3(found[i]) - expected));
    }
    EXPECT_GT(brightest, 0.05) << name_of(gather);
    EXPECT_LT(worst, 1e-4 * brightest)
        << name_of(gather);  // sums of floats; half volumes are exact
  }
}

TEST(RadianceAtPoints, NeedsASweep) {
  const SceneData scene = load_scene(kCornell);
  const std::vector<glm::vec4> at{{0.2f, 0.2f, 0.2f, 0}}, along{{0, 1, 0, 0}};
  const auto rejected = [&](const RenderOptions& options, bool rendered) {
    Frame frame(test_session(), scene, options);
    if (rendered) frame.render(scene.camera(""));
    return error_of(ExitCode::usage, [&] { frame.radiance_at(at, along); });
  };
  RenderOptions options = small_options(scene), steps = options;
  EXPECT_THAT(rejected(options, false), HasSubstr("radiance: no frame was rendered"));
  steps.transport = TransportKind::sampled, steps.grid = 5, steps.cascades = 1;
  steps.gather = Gathering::all, steps.blockers = Blockers::seen;  // the programs of kSmallSteps
  EXPECT_THAT(rejected(steps, true),
              AllOf(HasSubstr("transport 'sampled'"), HasSubstr("allowed: sweep")));
  options.layout = Layout::image, options.gather = Gathering::all;
  Frame packed(test_session(), scene, options);  // swept light is packed, also in images
  packed.render(scene.camera(""));
  EXPECT_EQ(packed.radiance_at(at, along).size(), 1u);
}

struct PointsFile : ::testing::Test {
  TemporaryFolder folder;
  std::vector<SurfacePoint> read(const std::string& text) {
    return read_points(folder.write("p.csv", text));
  }
  std::string rejected(const std::string& text) {
    const std::string message = error_of(ExitCode::bad_input, [&] { read(text); });
    EXPECT_THAT(message, HasSubstr("p.csv"));
    return message;
  }
};

TEST_F(PointsFile, LinesOfSixNumbers) {
  const auto points =
      read("\xEF\xBB\xBFx,y,z,nx,ny,nz\r\n1,2,3,0,0,2\r\n\n# a remark\n -1.5e1 , .5 ,0,\t-1,0,0");
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].position, glm::dvec3(1, 2, 3));
  EXPECT_EQ(points[0].normal, glm::dvec3(0, 0, 1)) << "made unit";
  EXPECT_EQ(points[1].position, glm::dvec3(-15, 0.5, 0));
  EXPECT_THAT(read(""), IsEmpty());
  EXPECT_THAT(read("x,y,z,nx,ny,nz\n"), IsEmpty());
}

TEST_F(PointsFile, BadLinesAreNamed) {
  for (const std::string bad :
       {"1,2,3,0,0", "1,2,3,0,0,1,7", "1,2,3,0,0,", "1,2,three,0,0,1", "1 2 3 0 0 1",
        "nan,2,3,0,0,1", "inf,2,3,0,0,1", "1,2,3,0,nan,1", "1,2,3,0,0,1e999", ","}) {
    EXPECT_THAT(rejected("0,0,0,0,0,1\n" + bad + "\n"),
                AllOf(HasSubstr("line 2"), HasSubstr("six finite numbers")))
        << bad;
  }
  EXPECT_THAT(rejected("nan,2,3,0,0,1"), HasSubstr("line 1"));
  EXPECT_THAT(rejected("x,y,z,nx,ny,nz\nx,y,z,nx,ny,nz\n"), HasSubstr("line 2"));
  EXPECT_THAT(rejected("1,2,3,0,0,0"), AllOf(HasSubstr("line 1"), HasSubstr("normal of length 0"),
                                             HasSubstr("a direction")));
  EXPECT_THAT(rejected("1e8,2,3,0,0,1"),
              AllOf(HasSubstr("line 1"), HasSubstr("within +-10000000 m")));
  EXPECT_THAT(rejected(std::string("1,2,3,0,0,1\n\0\0", 14)), HasSubstr("line 2"));
  EXPECT_THROW(read_points(folder / "none.csv"), Error);
  EXPECT_THROW(read_points(folder.path()), Error);
}

TEST(UnreachedSurfaces, AreReported) {
  const test::TemporaryFolder images;
  const std::string render = "render " + kCornell + " --width 48 --height 27 --rsm-size 64 -o " +
                             (images / "a.exr").string();
  const Outcome all = must_run_here(render + kSmallSweep);
  EXPECT_THAT(all.err, ::testing::Not(HasSubstr("outside the cascades")));
  const Outcome few = must_run_here(render + kSweepOfOne + "--cascade-size 1");
  EXPECT_THAT(few.err,
              ::testing::ContainsRegex(
                  "[0-9.]+ % of the visible surface lies outside the cascades and .* a sky"));
}

TEST_F(PointsFile, QueryAddsLightToEachPoint) {
  folder.write("p.csv", "0.28,0.45,0.3,0,-1,0\n900,0,0,0,1,0\n");
  const auto query = [&](const std::string& more) {
    return run_here("query " + kCornell + kSmallSweep +
                        "--points p.csv --width 48 --height 27 --rsm-size 64" + more,
                    folder.path());
  };
  const Outcome outcome = query("");
  ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("1 of 2 points lie outside the cascades"));
  EXPECT_THAT(outcome.out,
              AllOf(::testing::StartsWith("x,y,z,nx,ny,nz,red,green,blue\n0.28,0.45,0.3,0,-1,0,"),
                    ::testing::EndsWith("900,0,0,0,1,0,0,0,0\n")));
  const double red = std::atof(outcome.out.c_str() + outcome.out.find("0,-1,0,") + 7);
  EXPECT_GT(red, 0.01);
  EXPECT_EQ(query(" -o out.csv").out, "");
  EXPECT_EQ(test::read_file(folder / "out.csv"), outcome.out);
}

}  // namespace
}  // namespace clpv::test::query_test
