// SPDX-License-Identifier: MIT
// Shading against closed forms: Lambert's law for every kind of light, what each view shows, and the kernels' CPU reference.
#include "pipeline/shade.hpp"

#include "support/error.hpp"
#include "support/named_enum.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/shade_scenes.hpp"

namespace clpv::shade_test {
namespace {

using namespace shade_scenes;
using test::expect_passed;

TEST(Shade, DirectionalLightFollowsTheCosine) {
  for (const double degrees : {0.0, 35.0, 80.0}) {
    const double angle = degrees / 180 * pi;
    const MappedLight light = sun({std::sin(angle), -std::cos(angle), 0}, 7);
    expect_lit(
        floor_image(), light, [&](const glm::dvec3&) { return 7 * std::cos(angle); }, 7);
  }
}

TEST(Shade, PointLightFollowsCosineAndSquaredDistance) {
  const glm::dvec3 at(1, 2, -0.5);
  expect_lit(
      floor_image(), bulb(at, 40),
      [&](const glm::dvec3& p) {
        const double r = glm::length(at - p);
        return 40 * (at.y / r) / (r * r);
      },
      10);
}

TEST(Shade, NothingIsLitBeyondTheRange) {
  MappedLight light = bulb({0, 2, 0}, 40);
  light.light.range = 3;
  const SurfaceImage image = floor_image();
  const std::vector<double> e = lit(image, {light}), unlimited = lit(image, {bulb({0, 2, 0}, 40)});
  for (std::size_t pixel = 0; pixel < e.size(); ++pixel) {
    const double r = glm::length(point_of(image, pixel) - glm::dvec3(0, 2, 0));
    ASSERT_EQ(e[pixel], r <= 3 ? unlimited[pixel] : 0.0) << "at " << r << " m";
  }
}

TEST(Shade, SpotLightFadesAcrossItsCone) {
  const double inner = std::cos(0.3), outer = std::cos(0.6);
  MappedLight light = bulb({0, 4, 0}, 50);
  light.light.kind = CLPV_LIGHT_SPOT;
  set(light.light.direction, -kUp);
  light.light.cone_scale = static_cast<float>(1 / (inner - outer));
  light.light.cone_offset = static_cast<float>(-outer / (inner - outer));
  const auto expected = [&](const glm::dvec3& p) {
    const double r = glm::length(glm::dvec3(0, 4, 0) - p), cosine = 4 / r;
    const double cone = std::clamp((cosine - outer) / (inner - outer), 0.0, 1.0);
    return 50 * cone * cone * cosine / (r * r);
  };
  expect_lit(floor_image(), light, expected, 4);
}

TEST(Shade, AnUnknownKindOfLightIsDarkAndTheReferenceRejectsIt) {
  MappedLight light = bulb({0, 2, 0}, 40);
  light.light.kind = 3;
  for (const glm::vec4& pixel : show(Show::direct, floor_image(), {light}))
    ASSERT_EQ(glm::vec3(pixel), glm::vec3(0));
  EXPECT_THROW(reference::direct_irradiance({light}, floor_image()), Error);
}

TEST(Shade, LightsAddUp) {
  const SurfaceImage image = floor_image();
  const std::vector<MappedLight> lights = {sun({0.3, -1, 0}, 7), bulb({1, 2, 0}, 40)};
  const std::vector<double> both = lit(image, lights), one = lit(image, {lights[0]}),
                            other = lit(image, {lights[1]});
  for (std::size_t pixel = 0; pixel < both.size(); ++pixel) {
    ASSERT_NEAR(both[pixel], one[pixel] + other[pixel], 1e-5 * both[pixel]);
  }
}

TEST(Shade, LightFromBehindIsDark) {
  expect_lit(
      floor_image(), sun({0.2, 1, 0}, 7), [](const glm::dvec3&) { return 0; }, 7);
  expect_lit(
      floor_image(), bulb({0, -1, 0}, 7), [](const glm::dvec3&) { return 0; }, 7);
}

TEST(Shade, LightInTheSurfaceStaysFinite) {
  for (const double e : lit(floor_image(), {bulb(point_of(floor_image(), 4000), 1000)}))
    ASSERT_TRUE(std::isfinite(e));
}

TEST(Shade, EachViewShowsItsShare) {
  SurfaceImage image = floor_image();
  std::vector<cl_float4> indirect;
  for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
    const auto f = static_cast<float>(pixel % 7);
    image.colour[pixel] = glm::vec4(0.1f * f, 0.5f, 0.9f, 1);
    image.emissive.emplace_back(f, 0.25f, 0, 0);
    indirect.push_back({{1 + f, 2, 3, 0}});
    if (pixel % 5 == 0) image.depth[pixel] = 0;
  }
  const std::vector<MappedLight> lights = {sun({0, -1, 0}, 7)};
  std::vector<std::vector<glm::vec4>> shown;
  for (const Show view : values_of<Show>()) shown.push_back(show(view, image, lights, indirect));
  for (std::size_t pixel = 0; pixel < image.depth.size(); ++pixel) {
    const bool background = image.depth[pixel] <= 0;
    const glm::vec3 albedo(image.colour[pixel]), e(indirect[pixel].s[0], 2, 3), normal(0, 1, 0);
    const glm::vec3 bounced = albedo * static_cast<float>(1 / pi) * e;
    const glm::vec3 direct =
        albedo * static_cast<float>(1 / pi) * glm::vec3(7, 14, 21) + glm::vec3(image.emissive[pixel]);
    const glm::vec3 expected[] = {
        direct + bounced, direct, bounced, e, albedo, normal, glm::vec3(image.depth[pixel])};
    for (std::size_t s = 0; s < shown.size(); ++s) {
      const glm::vec4 wanted = background ? glm::vec4(0) : glm::vec4(expected[s], 1);
      for (int c = 0; c < 4; ++c) {
        ASSERT_NEAR(shown[s][pixel][c], wanted[c], background ? 0 : 1e-5)
            << names_of<Show>()[s] << ", pixel " << pixel;
      }
    }
  }
}

TEST(Shade, RejectsMapsThatDoNotFit) {
  const SurfaceImage image = floor_image();
  const Surface camera = upload_surface(test_session(), image);
  Shader shader(test_session());
  ShadowedLight shadowed = upload(sun({0, -1, 0}, 7, floor_at(0)));
  shadowed.views[0].width = 3;
  EXPECT_THROW(shader.light(camera, {shadowed}), Error);
  shadowed.views[0].width = kTexels;
  shadowed.depths.clear();
  EXPECT_THROW(shader.light(camera, {shadowed}), Error);
}

TEST(Shade, KernelsAgreeWithTheReference) {
  expect_passed(reference::check(Stage::shade, test_session()));
}

}  // namespace
}  // namespace clpv::shade_test
