// SPDX-License-Identifier: MIT
// Calls of the public interface in any order, messages, and light without a frame.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>

#include "cli/render_request.hpp"
#include "clpv/log.hpp"
#include "clpv/opencl.hpp"
#include "clpv/pathtrace.hpp"
#include "clpv/renderer.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/variable.hpp"

namespace clpv::api_calls_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

using test::kCornell;

const Vec3 kEye{0.3, 0.25, 0.2}, kElsewhere{-0.4, 0.5, 0.1};

TEST(ApiCalls, TheLibraryPrintsNothingAndTheReceiverGetsAll) {
  all_devices();  // chooses PoCL's cache, which keeps its place
  const test::Variable cache("CLPV_PROGRAM_CACHE", "on"),
      nowhere("XDG_CACHE_HOME", "/dev/null/nowhere");
  std::mutex mutex;
  std::vector<std::pair<LogLevel, std::string>> received;
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  set_log(
      [&](LogLevel level, const std::string& message) {
        const std::lock_guard lock(mutex);
        received.emplace_back(level, message);
      },
      LogLevel::debug);
  {
    Renderer(Scene(kCornell), test::few_steps()).render();
    TraceOptions options;
    options.width = options.height = 4, options.samples = 1;
    pathtrace(Scene(kCornell), View::full, {}, options);
  }
  set_log({});
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_THAT(received, Contains(testing::Pair(LogLevel::warning, HasSubstr("are not cached"))));
  EXPECT_THAT(received, Contains(testing::Pair(LogLevel::debug, HasSubstr("kernels/"))));
}

TEST(ApiCalls, HasTheLightOfAFrame) {
  const Scene scene(kCornell);
  Renderer framed(scene, test::small_options()), renderer(scene, test::small_options());
  EXPECT_THROW(renderer.update({NAN, 0, 0}), Error);
  Camera camera;
  camera.eye = kEye, camera.target = {kEye[0], kEye[1], kEye[2] - 1};
  framed.render(View::full, camera);
  renderer.update(kEye);
  const std::array<float, 3> places[] = {{0.1f, 0.2f, 0.3f}, {0.4f, 0.2f, 0.3f}};
  const std::array<float, 3> down[] = {{0, -1, 0}, {0, -1, 0}};
  EXPECT_EQ(renderer.irradiance(places, down), framed.irradiance(places, down));
  EXPECT_EQ(renderer.irradiance(places, std::span(down).first(1)), framed.irradiance(places, down))
      << "one normal for all";
  EXPECT_EQ(renderer.radiance(places, std::span(down).first(1)), framed.radiance(places, down));
  EXPECT_EQ(renderer.volumes().at(0).values, framed.volumes().at(0).values);
  EXPECT_THROW(renderer.show(View::full), Error) << "no frame";
}

TEST(ApiCalls, CellsAreThoseOfTheLastImage) {
  Scene scene(kCornell);
  Renderer renderer(scene, test::small_options());
  renderer.render();
  const Image cells = renderer.show(View::cells);
  renderer.update(kElsewhere);
  EXPECT_EQ(renderer.show(View::cells).pixels, cells.pixels);
  const std::vector<std::array<float, 3>> vectors(4, {0, 1, 0});
  const GBuffer surfaces{.width = 2, .height = 2, .normals = vectors, .positions = vectors};
  renderer.light(surfaces, kElsewhere);
  EXPECT_EQ(renderer.show(View::cells).pixels, cells.pixels);
  const std::array<double, 3> light = renderer.irradiance(kEye, {0, -1, 0});
  renderer.show(View::cells);
  EXPECT_EQ(renderer.irradiance(kEye, {0, -1, 0}), light) << "still of the last light()";
  renderer.update(kElsewhere);
  scene.set_lights(scene.lights());
  EXPECT_THAT(test::error_of(ExitCode::usage, [&] { renderer.show(View::cells); }),
              HasSubstr("scene that changed"));
}

TEST(ApiCalls, ARefusedCallKeepsTheLastFrame) {
  const Scene scene(kCornell);
  Renderer renderer(scene, test::small_options());
  const Image image = renderer.render();
  const std::array<double, 3> light = renderer.irradiance(kEye, {0, -1, 0});
  const std::vector<std::array<float, 3>> vectors(4, {0, 1, 0});
  const GBuffer surfaces{.width = 2, .height = 2, .normals = vectors, .positions = vectors};
  const Camera blind{.eye = kEye, .target = kEye};
  const std::function<void()> refused[] = {[&] { renderer.render(View::full, "nothing"); },
                                           [&] { renderer.render(View::full, blind); },
                                           [&] { renderer.render(View::full, {}, NAN); },
                                           [&] { renderer.enqueue(View::full, "nothing"); },
                                           [&] { renderer.light(surfaces, "nothing"); },
                                           [&] { renderer.light(surfaces, kEye, NAN); },
                                           [&] { renderer.update(kEye, NAN); }};
  for (const auto& call : refused) {
    test::error_of(ExitCode::usage, call);
    EXPECT_EQ(renderer.show(View::full).pixels, image.pixels);
    EXPECT_EQ(renderer.irradiance(kEye, {0, -1, 0}), light);
  }
}

TEST(ApiCalls, AnotherSizeIsThatOfAnotherRenderer) {
  const Scene scene(kCornell);
  for (const char* near_size : {"auto", "half"}) {
    Options options = test::small_options().set("near-size", near_size);
    Renderer renderer(scene, options);
    const Image before = renderer.render();
    const Image large = renderer.render(View::full, {}, 0, {{600, 400}});
    EXPECT_EQ(large.metadata.at("width"), "600");
    EXPECT_EQ(renderer.show(View::depth).width, 600);
    Renderer fresh(scene, options.set("width", "600").set("height", "400"));
    EXPECT_EQ(large.pixels, fresh.render().pixels);
    EXPECT_EQ(renderer.render().pixels, before.pixels);
    EXPECT_THROW(renderer.render(View::full, {}, 0, {{0, 5}}), Error);
  }
}

// More slices of tiles than the square of a work-item's least share (rasterize.cpp).
TEST(ApiCalls, ALargeImageShowsASmallOnesSurfaces) {
  Renderer renderer(Scene(kCornell), test::small_options().set("near", "off"));
  const Image small = renderer.render(View::depth, {}, 0, {{400, 300}}),
              large = renderer.render(View::depth, {}, 0, {{1200, 900}});
  std::size_t differing = 0;
  for (int y = 0; y < 300; ++y)
    for (int x = 0; x < 400; ++x)
      differing += !(std::abs(small.at(x, y, 0) - large.at(3 * x + 1, 3 * y + 1, 0)) < 1e-4);
  EXPECT_LT(differing, 20u) << "edges alone";
}

TEST(ApiCalls, MemoryComesBack) {
  Renderer renderer(Scene(kCornell), test::small_options());
  const Image before = renderer.render();
  renderer.release();
  EXPECT_LT(renderer.stats().device_bytes, 1u << 20);
  EXPECT_THROW(renderer.show(View::full), Error);
  EXPECT_THROW(renderer.irradiance(kEye, {0, 1, 0}), Error);
  EXPECT_THROW(renderer.lookup_source(), Error);
  EXPECT_EQ(renderer.render().pixels, before.pixels);
}

TEST(ApiCalls, MeshesThatComeLaterFitTheCascades) {
  const std::vector<std::array<float, 3>> corners{{-40, 0, -40}, {40, 0, -40}, {0, 0, 40}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 2, 1}};
  Scene scene, built;
  Renderer early(scene, test::small_options());
  for (Scene* each : {&scene, &built})
    each->add_mesh({.positions = corners, .triangles = triangles});
  EXPECT_EQ(early.render().metadata, Renderer(built, test::small_options()).render().metadata);
}

TEST(ApiCalls, HelpersCompileTheProgramsOfTheMedium) {
  RenderRequest request;
  request.scene = kCornell;
  request.changes.medium = ClpvMedium{};
  request.changes.medium->anisotropy = 0.5f;
  request.changes.medium->extinction[0] = 0.25f;
  EXPECT_THAT(compilation_of(request, {}, "").helpers, Contains("--medium=0,0.25,0.5"));
}

// Options of a bake's frames are not the ones that its user gave.
TEST(ApiCalls, HelpersHaveTheOptionsOfTheFrames) {
  RenderOptions options;
  for (const PresetName preset : values_of<PresetName>()) {
    apply_preset(options, preset);
    options.cascades = 5, options.cascade_size = 1.0 / 3, options.near = Near::off;
    options.bounces = Bounces::one;
    OptionValues given;
    for (const std::string& argument : compilation_of({}, options, "").helpers) {
      const auto equals = argument.find('=');
      if (equals == std::string::npos) continue;
      const std::string name = argument.substr(2, equals - 2);
      given[name == "near-field" ? "near" : name] = argument.substr(equals + 1);
    }
    EXPECT_EQ(to_json(resolve_options(given, SceneData{})), to_json(options)) << name_of(preset);
  }
}

}  // namespace
}  // namespace clpv::api_calls_test
