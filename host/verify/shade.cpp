// SPDX-License-Identifier: MIT
// Shading: kernels against CPU reference, on random surfaces and random shadow maps of all kinds of
// light.
#include "pipeline/raster/shade.hpp"

#include <algorithm>
#include <optional>
#include <random>

#include "pipeline/raster/view.hpp"
#include "reference/shade.hpp"
#include "support/named_enum.hpp"
#include "verify/check.hpp"
#include "verify/expected.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {
namespace {

constexpr unsigned kMapWidth = 24, kMapHeight = 20;
constexpr float kMapReach = 20;  // [m]: range of depths in a map

/// Independent random depths per texel, 1 of 3 empty, so that a wrong filter address causes an
/// error.
reference::ShadowMap random_map(const ClpvView& view, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-0.5f, 1);
  reference::ShadowMap map{view, {}};
  for (unsigned texel = 0; texel < kMapWidth * kMapHeight; ++texel) {
    map.depth.push_back(std::max(0.0f, kMapReach * uniform(random)));
  }
  return map;
}

const ClpvLight kSun{
    {}, CLPV_LIGHT_DIRECTIONAL, {2 / 7.0f, -6 / 7.0f, 3 / 7.0f}, 0, {3, 2, 1}, 0, 0, 0, {}, {}};
/// Cone from full light at acos(0.9) to dark at acos(0.7).
const ClpvLight kSpot{{6, 8, -1},
                      CLPV_LIGHT_SPOT,
                      {-1 / 9.0f, -8 / 9.0f, 4 / 9.0f},
                      14,
                      {100, 150, 200},
                      5,
                      -3.5f,
                      0,
                      {},
                      {}};
const ClpvLight kPoint{{5, 1.5f, 0.3f}, CLPV_LIGHT_POINT, {}, 0, {60, 50, 40}, 0, 0, 0, {}, {}};

/// The sun's map is smaller than the camera's view: some surfaces lie on and beyond its edge.
reference::MappedLight mapped(const ClpvLight& light, std::mt19937& random) {
  const Bounds bounds{{-2, -2, -4}, {8, 8, 6}};
  reference::MappedLight mapped{light, {}};
  for (ClpvView view : shadow_views(light, bounds, kMapWidth)) {
    view.height = kMapHeight;
    mapped.maps.push_back(random_map(view, random));
  }
  return mapped;
}

/// Surfaces, their indirect light, and lights of all kinds, in the order of kKinds.
struct ShadeInputs {
  SurfaceImage image;
  std::vector<cl_float4> irradiance;
  std::vector<reference::MappedLight> lights;
};
constexpr const char* kKinds[] = {"directional", "spot", "point", "no shadow"};

ShadeInputs random_inputs() {
  std::mt19937 random(17);
  std::uniform_real_distribution<float> uniform(0, 5);
  ShadeInputs inputs{random_surfaces(random), {}, {}};
  for (std::size_t pixel = 0; pixel < inputs.image.depth.size(); ++pixel)
    inputs.irradiance.push_back({{uniform(random), uniform(random), uniform(random), 0}});
  inputs.lights = {
      mapped(kSun, random), mapped(kSpot, random), mapped(kPoint, random), {kPoint, {}}};
  return inputs;
}

/// Compares a view under one of the lights, or under all.
Deviation compare_view(Session& session, Show show, std::optional<std::size_t> chosen) {
  ShadeInputs inputs = random_inputs();
  if (chosen) inputs.lights = {inputs.lights[*chosen]};
  const SurfaceImage& image = inputs.image;
  const std::size_t pixels = image.depth.size();
  const Surface camera = upload_surface(session, image);
  const Buffer gathered = session.upload(inputs.irradiance, "check: irradiance");
  Buffer shown = session.buffer(pixels * sizeof(cl_float4), "check: image");
  Shader shader(session);
  shader.light(camera, on_device(session, inputs.lights));
  shader.show(show, camera, gathered, shown);
  std::vector<glm::dvec3> indirect;
  for (const cl_float4& e : inputs.irradiance) indirect.push_back(vector(e.s));
  std::vector<double> expected;
  for (const glm::dvec4& pixel :
       reference::shade(show, image, reference::direct_irradiance(inputs.lights, image), indirect))
    append_pixel(expected, glm::dvec3(pixel), pixel.w);
  expect_pixels(session, shown, expected, tolerance("shade"));
  return compare_pixels(session.read<cl_float4>(shown, pixels), expected, image.view.width,
                        tolerance("shade"));
}

}  // namespace

Cases shade_cases(const CheckScope&) {
  Cases cases;
  const auto add = [&](const std::string& name, Show show, std::optional<std::size_t> chosen) {
    cases.push_back(deviation_case(
        Stage::shade, name, [=](Session& session) { return compare_view(session, show, chosen); }));
  };
  for (std::size_t i = 0; i < std::size(kKinds); ++i) add(kKinds[i], Show::direct, i);
  for (const Show show : kSurfaceViews)
    add(fmt::format("view {}", name_of(show)), show, std::nullopt);
  return cases;
}

}  // namespace clpv::verify
