// SPDX-License-Identifier: MIT
// Panes over an open room: the sun comes in through those that stop less than half of light, and
// the room is that without a pane, in kernels, reference and path tracer.
#include <gmock/gmock.h>

#include "image/compare.hpp"
#include "pipeline/frame/frame.hpp"
#include "pipeline/raster/view.hpp"
#include "reference/blockers.hpp"
#include "reference/near.hpp"
#include "reference/rasterize.hpp"
#include "tests/support/gltf_builder.hpp"
#include "tests/support/on_device.hpp"
#include "tests/support/traced_scenes.hpp"

namespace clpv::test::glass_test {
namespace {

constexpr unsigned kSize = 48;
constexpr float kHalf = 2, kTurn = 0.70710678f;
constexpr double kEqual = 1e-6;  // relative; other programs, with the look-up of alpha, may round

struct Pane {
  std::string name;
  json material;
  double vertex_alpha;  // below 1 the triangles stay, and alpha is looked up
  bool open;
};

json transmits(double factor, const json& colour, const std::string& mode = "OPAQUE") {
  return {{"pbrMetallicRoughness", {{"baseColorFactor", colour}}},
          {"alphaMode", mode},
          {"doubleSided", true},
          {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", factor}}}}}};
}

SceneData room(const TemporaryFolder& folder, const Pane* pane) {
  GltfBuilder model;
  model.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {0.6, 0.6, 0.6, 1}}}}});
  model.square(kHalf)["material"] = 0;
  for (const json& turned : {json{0, 0, -kTurn, kTurn},
                             {0, 0, kTurn, kTurn},
                             {kTurn, 0, 0, kTurn},
                             {-kTurn, 0, 0, kTurn}}) {
    const float x = turned[2].get<float>(), z = turned[0].get<float>(), to = kHalf / kTurn;
    model.add("nodes",
              {{"mesh", 0}, {"rotation", turned}, {"translation", {x * to, kHalf, -z * to}}});
  }
  if (pane != nullptr) {
    model.add("materials", pane->material);
    std::vector<float> colours;
    for (int i = 0; i < 4; ++i)
      colours.insert(colours.end(), {1, 1, 1, static_cast<float>(pane->vertex_alpha)});
    json& primitive = model.square(kHalf);
    primitive["material"] = 1;
    primitive["attributes"]["COLOR_0"] = model.accessor<float>("VEC4", colours);
    model.document["nodes"].back()["translation"] = {0, 2 * kHalf, 0};
  }
  SceneData scene = load_scene(model.write(folder));
  scene.lights = {sun({0.3f, -1, 0.2f}, 10)};
  scene.cameras = {camera_at({-1.5f, 2, 1.5f}, {1, -0.6f, -1})};
  return scene;
}

Image rendered(const SceneData& scene) {
  RenderOptions options = small_sweep();
  options.width = options.height = kSize;
  options.cascades = 1;
  Frame frame(test_session(), scene, options);
  frame.render(scene.camera(""));
  Image image = make_image(kSize, kSize, {"R", "G", "B", "A"});
  image.pixels = frame.read(Show::full);
  return image;
}

Image traced(const SceneData& scene) {
  PathTracerOptions options;
  options.samples = 4;
  const ClpvView view = view_of({-1.5f, 2, 1.5f}, {1, -0.6f, -1}, {0, 1, 0}, 1, kSize, kSize);
  return pathtracer::traced_view(trace_paths(scene, view, options), Show::full);
}

/// Depths of the sun's view, by the reference.
std::vector<float> sunlit(const SceneData& scene) {
  const ClpvGrid grid{{-kHalf, 0, -kHalf}, kHalf / 4, 8, {}};
  const ClpvLight& light = scene.lights[0].data;
  return reference::rasterize_rsm(
             scene, light, directional_rsm_view(light, grid, {scene.lower, scene.upper}, kSize))
      .image.depth;
}

TEST(Glass, LightComesInAsWithoutAPane) {
  const TemporaryFolder folder;
  const SceneData bare = room(folder, nullptr);
  const Image by_kernels = rendered(bare), by_paths = traced(bare);
  const json clear = {1, 1, 1, 1}, thin = {1, 1, 1, 0.1}, green = {0.2, 1, 0.6, 1};
  for (const Pane& pane : {Pane{"clear glass", transmits(1, clear), 1, true},
                           {"tinted glass", transmits(0.9, green), 1, true},
                           {"dark glass", transmits(0.8, green), 1, false},
                           {"blending", transmits(0, thin, "BLEND"), 1, true},
                           {"blending by vertices", transmits(0, clear, "BLEND"), 0.4, true},
                           {"blending to a wall", transmits(0, clear, "BLEND"), 0.6, false},
                           {"blending glass", transmits(0.4, clear, "BLEND"), 0.8, true},
                           {"masked", transmits(0, thin, "MASK"), 1, true}}) {
    SCOPED_TRACE(pane.name);
    const SceneData scene = room(folder, &pane);
    EXPECT_EQ(scene.triangles.size() > bare.triangles.size(), pane.vertex_alpha < 1 || !pane.open);
    const Comparison kernels = compare(rendered(scene), "pane", by_kernels, "none"),
                     paths = compare(traced(scene), "pane", by_paths, "none");
    const reference::Materials materials(scene);
    bool uncertain = false;
    const auto above =
        reference::nearest_triangle(scene, materials, {{0, 1, 0}, {0, 1, 0}, 10}, uncertain);
    const ClpvGrid grid{{-kHalf, 0, -kHalf}, kHalf / 4, 8, {}};
    const bool no_blocker = reference::voxelize_blockers(scene, grid).upper.values ==
                            reference::voxelize_blockers(bare, grid).upper.values;
    EXPECT_EQ(above.has_value(), !pane.open);
    EXPECT_EQ(no_blocker, pane.open);
    EXPECT_EQ(sunlit(scene) == sunlit(bare), pane.open);
    if (pane.open) {
      EXPECT_LT(kernels.nrmse.value(), kEqual);
      EXPECT_LT(paths.nrmse.value(), kEqual);
    } else {
      EXPECT_GT(kernels.nrmse.value(), 0.9) << "dark";
      EXPECT_GT(paths.nrmse.value(), 0.9);
    }
  }
}

}  // namespace
}  // namespace clpv::test::glass_test
