// SPDX-License-Identifier: MIT
// Blockers, reflectors and visibility: kernels against CPU references on random triangles of all
// sizes, textured and masked.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <random>

#include "basis/bounce.hpp"
#include "kernels/shared/reflectors.h"
#include "pipeline/raster/shade.hpp"
#include "pipeline/raster/view.hpp"
#include "pipeline/voxels/voxel_field.hpp"
#include "reference/blockers.hpp"
#include "reference/shade.hpp"
#include "support/named_enum.hpp"
#include "verify/check.hpp"
#include "verify/inputs.hpp"
#include "verify/tolerances.hpp"

namespace clpv::verify {

namespace {

constexpr int kTrianglesGrid = 9;  // no multiple of a work-group
const ClpvGrid kTrianglesCells = {{-2.5f, 0.5f, 1.0f}, 0.5f, kTrianglesGrid, {}};

/// Returns "x,y,z" of the sample that contains a number, for n samples along each axis.
std::string sample_of(std::size_t number, std::size_t n) {
  return fmt::format("{},{},{}", number % n, number / n % n, number / n / n % n);
}

/// One case per volume format, the default first.
Cases cases_of_formats(Stage stage, const CheckScope& scope,
                       const std::function<Deviation(Session&, const VolumeFormat&)>& compare) {
  std::vector<VolumeFormat> formats = scope.formats;
  formats.insert(formats.begin(), VolumeFormat{});
  Cases cases;
  for (const VolumeFormat& format : formats) {
    cases.push_back(deviation_case(stage, format_name(format),
                                   [=](Session& session) { return compare(session, format); }));
  }
  return cases;
}

Deviation compare_blockers(Session& session, const VolumeFormat& format) {
  const SceneData scene = triangle_soup();
  const SceneBuffers buffers = upload_scene(session, scene);
  Volume geometry(session, {kTrianglesGrid + 1, 3, 1}, "check: blockers", format);
  VoxelField(session, buffers, blocker_masks(buffers, kTrianglesGrid, 1, format))
      .update(0, kTrianglesCells, geometry);
  const std::vector<float> found = geometry.read(session);
  const reference::BlockerBounds expected = reference::voxelize_blockers(scene, kTrianglesCells);
  Ranges ranges;
  for (std::size_t at = 0; at < found.size(); ++at)
    ranges.push_back({expected.lower.values[at], expected.upper.values[at]});
  expect(session, geometry, ranges);
  Deviation result{0, tolerance("blockers", format.storage)};
  for (std::size_t at = 0; at < found.size(); ++at) {
    const double share = found[at], lower = expected.lower.values[at],
                 upper = expected.upper.values[at];
    result.take(std::max(lower - share, share - upper), [&] {
      return fmt::format("corner {} axis {}: {}, expected {} to {}",
                         sample_of(at, kTrianglesGrid + 1), at / (found.size() / 3), share, lower,
                         upper);
    });
  }
  return result;
}

Deviation compare_reflectors(Session& session, const VolumeFormat& format, bool white) {
  const SceneData scene = triangle_soup();
  const SceneBuffers buffers = upload_scene(session, scene);
  Volume reflectors(session, {kTrianglesGrid, kCellFaces, CLPV_REFLECTOR_CHANNELS},
                    "check: reflectors", format);
  VoxelField(session, buffers, reflector_masks(buffers, kTrianglesGrid, format, white))
      .update(0, kTrianglesCells, reflectors);
  const std::vector<float> found = reflectors.read(session);
  const reference::ReflectingAreas expected =
      reference::voxelize_reflectors(scene, kTrianglesCells, white);
  Deviation result{0, tolerance("reflectors", format.storage)};
  Ranges ranges;
  for (std::size_t at = 0; at < found.size(); ++at) {
    const double wanted = expected.areas.values[at],
                 tolerated = expected.tolerance.values[at] + result.allowed;
    ranges.push_back({wanted - tolerated, wanted + tolerated});
  }
  expect(session, reflectors, ranges);
  for (std::size_t at = 0; at < found.size(); ++at) {
    const double wanted = expected.areas.values[at], tolerated = expected.tolerance.values[at];
    result.take(std::abs(found[at] - wanted) - tolerated, [&] {
      const std::size_t plane = at / (kTrianglesGrid * kTrianglesGrid * kTrianglesGrid);
      return fmt::format("cell {} side {} channel {}: {:.6g}, expected {:.6g}",
                         sample_of(at, kTrianglesGrid), plane % kCellFaces, plane / kCellFaces,
                         found[at], wanted);
    });
  }
  return result;
}

Deviation compare_visibility(Session& session) {
  constexpr std::size_t kCascade = 1;  // not the first
  const SceneData scene = triangle_soup();
  const SceneBuffers buffers = upload_scene(session, scene);
  const reference::Occlusion expected = reference::occlude(scene, kTrianglesCells);
  VoxelField visibility(session, buffers, visibility_masks(kTrianglesGrid, kCascade + 1));
  // From a cell beside it: most masks move, one layer is computed.
  visibility.update(kCascade, {{-2.0f, 0.5f, 1.0f}, 0.5f, kTrianglesGrid, {}});
  visibility.update(kCascade, kTrianglesCells);
  const std::size_t bytes = visibility_bytes(kTrianglesGrid);
  const auto found = session.read<std::uint8_t>(visibility.masks(), bytes * (kCascade + 1));
  Ranges ranges(kCascade * bytes);
  for (std::size_t point = 0; point < bytes; ++point)
    ranges.push_back({double(expected.lower[point]), double(expected.upper[point])});
  expect(session, visibility.masks(), "bits", ranges);
  Deviation result{0, tolerance("visibility")};
  for (std::size_t point = 0; point < bytes; ++point) {
    const std::uint8_t bits = found[kCascade * bytes + point], lower = expected.lower[point],
                       upper = expected.upper[point];
    const unsigned wrong = (lower & ~bits) | (bits & ~upper);
    result.take(std::popcount(wrong), [&] {
      return fmt::format("cube {} point {}: {:08b}, expected {:08b} to {:08b}",
                         sample_of(point / 64, kTrianglesGrid), point % 64, bits, lower, upper);
    });
  }
  return result;
}

// Shading: kernels against CPU reference, on random surfaces and random shadow maps of all kinds of
// light.

constexpr unsigned kMapWidth = 24, kMapHeight = 20;
constexpr float kMapReach = 20;  // [m]: range of depths in a map

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

/// Independent random depths per texel, 1 of 3 empty, so that a wrong filter address causes an
/// error. The sun's map is smaller than the camera's view: some surfaces lie on and beyond its
/// edge.
reference::MappedLight mapped(const ClpvLight& light, std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(-0.5f, 1);
  return mapped_light(light, {{-2, -2, -4}, {8, 8, 6}}, kMapWidth, kMapHeight,
                      [&] { return std::max(0.0f, kMapReach * uniform(random)); });
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
  const Surface camera = upload_surface(session, image);
  const Buffer gathered = session.upload(inputs.irradiance, "check: irradiance");
  Buffer shown = session.buffer(image.depth.size() * sizeof(cl_float4), "check: image");
  Shader shader(session);
  shader.light(camera, on_device(session, inputs.lights));
  shader.show(show, camera, gathered, shown);
  std::vector<glm::dvec3> indirect;
  for (const cl_float4& e : inputs.irradiance) indirect.push_back(vector(e.s));
  std::vector<double> expected;
  for (const glm::dvec4& pixel :
       reference::shade(show, image, reference::direct_irradiance(inputs.lights, image), indirect))
    append_pixel(expected, glm::dvec3(pixel), pixel.w);
  return compare_pixels(session, shown, expected, image.view.width, tolerance("shade"));
}

}  // namespace

Cases blockers_cases(const CheckScope& scope) {
  return cases_of_formats(Stage::blockers, scope, compare_blockers);
}

Cases reflectors_cases(const CheckScope& scope) {
  Cases cases =
      cases_of_formats(Stage::reflectors, scope, [](Session& session, const VolumeFormat& format) {
        return compare_reflectors(session, format, false);
      });
  cases.push_back(deviation_case(Stage::reflectors, "white", [](Session& session) {
    return compare_reflectors(session, {}, true);
  }));
  return cases;
}

Cases visibility_cases(const CheckScope&) {
  return {deviation_case(Stage::visibility, "triangles", compare_visibility)};
}

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
