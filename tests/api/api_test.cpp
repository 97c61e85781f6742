// SPDX-License-Identifier: MIT
// The public interface of the library (include/clpv).

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cli/render_request.hpp"
#include "clpv/compare.hpp"
#include "clpv/opencl.hpp"
#include "clpv/renderer.hpp"
#include "tests/support/error_of.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/numbers.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/scenes.hpp"

namespace clpv::api_test {

using ::testing::HasSubstr;

using test::kCornell;
using test::mean;

TEST(Api, AnimatedScenesRenderAtAnyTime) {
  const test::TemporaryFolder folder;
  const Scene scene(test::write_moving_scene(folder));
  EXPECT_TRUE(scene.moves());
  EXPECT_FALSE(Scene(kCornell).moves());
  Renderer renderer(scene, test::small_options()), other(scene, test::small_options());
  const Image start = renderer.render(), later = renderer.render(View::full, {}, 0.6);
  const auto light = renderer.irradiance({0, 0.5, 0}, {0, -1, 0});
  EXPECT_NE(start.pixels, later.pixels);
  EXPECT_EQ(later.metadata.at("time"), "0.6");
  EXPECT_EQ(other.render(View::full, {}, 0.6).pixels, later.pixels)
      << "each renderer has its own instant";
  EXPECT_EQ(renderer.render().pixels, start.pixels);
  EXPECT_NE(renderer.irradiance({0, 0.5, 0}, {0, -1, 0}), light) << "of the last frame";
  EXPECT_THROW(renderer.render(View::full, {}, NAN), Error);
  EXPECT_THROW(renderer.render(View::full, {}, 1e9), Error);
}

Camera front() {
  const auto all = Scene(kCornell).cameras();
  return *std::ranges::find(all, "front", &Camera::name);
}

TEST(Api, BadCamerasAreRejectedWithTheirMember) {
  Renderer renderer(Scene(kCornell), test::small_options());
  const auto rejected = [&](const std::string& member, auto change) {
    Camera camera = front();
    change(camera);
    EXPECT_THAT(test::error_of(ExitCode::usage, [&] { renderer.render(View::full, camera); }),
                ::testing::AllOf(HasSubstr("camera: " + member + ": found"), HasSubstr("allowed")));
  };
  const double infinity = std::numeric_limits<double>::infinity();
  rejected("target", [](Camera& c) { c.target = c.eye; });
  rejected("eye", [](Camera& c) { c.eye[1] = NAN; });
  rejected("target", [&](Camera& c) { c.target[2] = -infinity; });
  rejected("up", [](Camera& c) { c.up = {0, 0, 0}; });
  rejected("up", [](Camera& c) { c.up = {0, 0, 2}; });
  rejected("light", [](Camera& c) { c.light = "none of this name"; });
  for (const double angle : {0.0, 180.0, -1.0, double{NAN}})
    rejected("vertical_fov_degrees", [&](Camera& c) { c.vertical_fov_degrees = angle; });
  for (const double near : {0.0, -1.0, infinity})
    rejected("near", [&](Camera& c) { c.near = near; });
}

TEST(Api, CamerasOfASceneCanBeChanged) {
  Scene scene(kCornell);
  Renderer renderer(scene, test::small_options());
  const Image before = renderer.render(View::full, "front");
  std::vector<Camera> cameras = scene.cameras();
  Camera added = front();
  added.name = "added";
  cameras.push_back(added);
  scene.set_cameras(cameras);
  EXPECT_LT(compare(renderer.render(View::full, "added"), before).max_error, 1e-4);
  EXPECT_THROW(scene.set_cameras({}), Error);
  cameras.push_back(added);
  EXPECT_THAT(test::error_of(ExitCode::usage, [&] { scene.set_cameras(cameras); }),
              HasSubstr("duplicate 'added'"));
  EXPECT_EQ(scene.cameras().back().name, "added") << "unchanged after an error";
  scene.set_cameras({{.eye = {0.1, 1, 3}, .target = {0, 1, -7}, .vertical_fov_degrees = 37.3}});
  EXPECT_EQ(scene.cameras()[0].target, (Vec3{0, 1, -7})) << "as it was set";
  EXPECT_EQ(scene.cameras()[0].vertical_fov_degrees, 37.3);
}

TEST(Api, LightsKeepTheirNumbers) {
  Scene scene(kCornell);
  const Light spot{LightKind::spot, {1, 2, 3}, {0, 0, -2}, {1, 2, 4}, 5, 20, 60, "a"};
  const Light sun{.direction = {1, -1, 0}, .name = "b"};
  scene.set_lights({spot, sun});
  const auto lights = scene.lights();
  ASSERT_EQ(lights.size(), 2u);
  EXPECT_EQ(lights[0].kind, LightKind::spot);
  EXPECT_EQ(lights[0].position, spot.position);
  EXPECT_EQ(lights[0].direction, spot.direction) << "as it was set";
  EXPECT_EQ(lights[0].intensity, spot.intensity);
  EXPECT_EQ(lights[0].range, 5);
  EXPECT_EQ(lights[0].inner_cone_degrees, 20);
  EXPECT_EQ(lights[0].outer_cone_degrees, 60);
  EXPECT_EQ(lights[1].name, "b");
  const auto rejected = [&](const std::string& member, Light light) {
    EXPECT_THAT(test::error_of(ExitCode::usage,
                               [&] {
                                 scene.set_lights({sun, light});
                               }),
                HasSubstr("lights[1]: " + member));
  };
  rejected("direction", {.direction = {0, 0, 0}});
  rejected("intensity", {.intensity = {1, -1, 1}});
  rejected("intensity", {.intensity = {1, 1, NAN}});
  rejected("position", {.kind = LightKind::point, .position = {NAN, 0, 0}});
  rejected("range", {.kind = LightKind::point, .range = -1});
  rejected("found inner_cone_degrees 50",
           {.kind = LightKind::spot, .inner_cone_degrees = 50, .outer_cone_degrees = 40});
  rejected("kind", {.kind = static_cast<LightKind>(7)});
  EXPECT_THROW(scene.set_lights(std::vector<Light>(65)), Error);
}

TEST(Api, AMediumCanBeSetAndRemoved) {
  Scene scene(kCornell);
  Renderer renderer(scene, test::small_options());
  const Image clear = renderer.render();
  EXPECT_FALSE(scene.medium());
  const Medium fog{.scattering = {0.5, 0.5, 0.5}, .absorption = {0, 1, 2}, .anisotropy = 0.25};
  scene.set_medium(fog);
  EXPECT_EQ(scene.medium()->scattering, fog.scattering);
  EXPECT_EQ(scene.medium()->absorption, fog.absorption);
  EXPECT_FALSE(scene.medium()->box) << "as it was set";
  const Image foggy = renderer.render();
  EXPECT_LT(mean(foggy.pixels, 2), 0.9 * mean(clear.pixels, 2)) << "blue is absorbed";
  EXPECT_GT(mean(renderer.show(View::medium).pixels, 0), 0);
  scene.set_medium({});
  EXPECT_EQ(renderer.render().pixels, clear.pixels);
  const auto rejected = [&](const std::string& member, const Medium& medium) {
    EXPECT_THAT(test::error_of(ExitCode::usage, [&] { scene.set_medium(medium); }),
                HasSubstr("medium: " + member));
  };
  rejected("scattering", {.scattering = {-1, 0, 0}});
  rejected("absorption", {.absorption = {0, NAN, 0}});
  rejected("anisotropy", {.anisotropy = 1});
  rejected("box", {.box = std::array{Vec3{0, 0, 0}, Vec3{1, 0, 1}}});
}

TEST(Api, ASkyCanBeSetAndRemoved) {
  const test::TemporaryFolder folder;
  std::filesystem::copy_file(CLPV_SOURCE_DIR "/scenes/cornell.glb", folder / "room.glb");
  const Scene file(folder.write("sky.json", R"({"model": "room.glb",
      "sky": {"radiance": [1, 2, 3], "ground": [0.5, 0, 0]}})"));
  Scene scene(folder.write("room.json", R"({"model": "room.glb"})"));
  scene.set_lights({});  // without the sun that a scene without a sky gets
  Renderer renderer(scene, test::small_options());
  const Image before = renderer.render();
  scene.set_sky({1, 2, 3}, {0.5, 0, 0});
  const Image lit = renderer.render();
  EXPECT_EQ(lit.pixels, Renderer(file, test::small_options()).render().pixels);
  EXPECT_NE(lit.pixels, before.pixels);
  scene.set_sky({1, 2, 3}, {1, 2, 3});
  const Image even = renderer.render();
  Image texel;
  texel.width = texel.height = 1, texel.channels = {"R", "G", "B"}, texel.pixels = {1, 2, 3};
  save_image(folder / "sky.exr", texel);
  scene.set_sky({});
  EXPECT_EQ(renderer.render().pixels, before.pixels);
  scene.set_sky_map(folder / "sky.exr");
  EXPECT_EQ(renderer.render().pixels, even.pixels);
  EXPECT_THROW(scene.set_sky({1, -1, 0}), Error);
  EXPECT_THROW(scene.set_sky({}, {0, 0, NAN}), Error);
  EXPECT_THROW(scene.set_sky_map(folder / "sky.exr", 1, 400), Error);
  EXPECT_THROW(scene.set_sky_map(folder / "none.exr"), Error);
}

TEST(Api, VolumesHoldTheLight) {
  Renderer renderer(Scene(kCornell), test::small_options());
  EXPECT_THROW(renderer.volumes(), Error) << "before the first frame";
  renderer.render();
  const auto volumes = renderer.volumes();
  ASSERT_FALSE(volumes.empty());
  for (const LightVolume& v : volumes) {
    EXPECT_EQ(v.n, 16);
    EXPECT_EQ(v.coefficients, 9);
    EXPECT_EQ(v.basis, "sh3");
    EXPECT_EQ(v.values.size(), 3u * 9 * 16 * 16 * 16);
  }
  EXPECT_GT(volumes.back().cell, volumes.front().cell);
  // At the centre of a cell: the 0th harmonic of radiance L is L sqrt(4 pi), the mean irradiance pi
  // L where L varies little, over the furnace's.
  const LightVolume& v = volumes.front();
  const Vec3 about{0.1, 0.4, 0.1};
  std::size_t cell[3];
  Vec3 centre;
  for (int i = 0; i < 3; ++i) {
    cell[i] = static_cast<std::size_t>((about[i] - v.origin[i]) / v.cell);
    centre[i] = v.origin[i] + (static_cast<double>(cell[i]) + 0.5) * v.cell;
  }
  const std::size_t at = (cell[2] * 16 + cell[1]) * 16 + cell[0];
  const double radiance = v.values[at] / v.furnace[at] / (v.cell * v.cell);
  double irradiance = 0;
  for (const Vec3& n : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1},
                        Vec3{0, 0, -1}})
    irradiance += renderer.irradiance(centre, n)[0] / 6;
  EXPECT_NEAR(irradiance / (M_PI * radiance), 1, 0.1);
}

TEST(Api, IrradianceOfManyPointsIsThatOfEach) {
  Renderer renderer(Scene(kCornell), test::small_options());
  renderer.render();
  std::vector<std::array<float, 3>> positions, normals;
  for (int i = 0; i < 1100; ++i) {  // more than a row of the points' image
    positions.push_back({0.1f + 0.0003f * i, 0.27f, 0.3f});
    normals.push_back({0, i % 2 == 0 ? -1.0f : 3.0f, 0});
  }
  const auto all = renderer.irradiance(positions, normals);
  ASSERT_EQ(all.size(), positions.size());
  for (const std::size_t i : {0u, 1u, 7u, 1023u, 1024u, 1099u}) {
    const auto one = renderer.irradiance(Vec3{positions[i][0], positions[i][1], positions[i][2]},
                                         Vec3{0, normals[i][1], 0});
    for (int c = 0; c < 3; ++c) EXPECT_EQ(all[i][c], static_cast<float>(one[c])) << i;
  }
  EXPECT_TRUE(
      renderer.irradiance(std::span(positions).first(0), std::span(normals).first(0)).empty());
  normals.pop_back();
  EXPECT_THROW(renderer.irradiance(positions, normals), Error);
  normals.push_back({0, 0, 0});
  EXPECT_THAT(test::error_of(ExitCode::usage, [&] { renderer.irradiance(positions, normals); }),
              HasSubstr("point 1099"));
  EXPECT_THROW(renderer.irradiance({0, NAN, 0}, {0, 1, 0}), Error);
}

// A move once left a Renderer whose calls crashed.
TEST(Api, ARendererThatWasMovedFromIsNamed) {
  Scene scene(kCornell);
  Renderer first(scene, test::small_options());
  const Scene moved = std::move(scene);
  EXPECT_EQ(scene.cameras().size(), moved.cameras().size()) << "a Scene is never empty";
  Renderer second = std::move(first);
  for (const auto& call : std::initializer_list<std::function<void()>>{
           [&] { first.render(); }, [&] { first.show(View::full); }, [&] { first.stats(); },
           [&] { first.description(); }, [&] { first.volumes(); }, [&] { first.lookup_source(); }})
    EXPECT_THAT(test::error_of(ExitCode::usage, call), HasSubstr("moved from"));
  EXPECT_EQ(second.render().width, 48);
}

// Calls of the public interface in any order, and light without a frame.

const Vec3 kEye{0.3, 0.25, 0.2}, kElsewhere{-0.4, 0.5, 0.1};

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
      given[argument.substr(2, equals - 2)] = argument.substr(equals + 1);
    }
    EXPECT_EQ(to_json(resolve_options(given, SceneData{})), to_json(options)) << name_of(preset);
  }
}

}  // namespace clpv::api_test
