// SPDX-License-Identifier: MIT
// Workloads that no command of clpv runs: workloads NAME [SCENE].
#include <cmath>
#include <cstdio>
#include <string_view>

#include "clpv/renderer.hpp"
#include "device/session.hpp"
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/load.hpp"

namespace clpv {
namespace {

/// Draws shadow maps in two parts, as those of scenes of many more triangles.
void hidden_clusters(const char* file) {
  constexpr int kSize = 16;
  SceneData scene = load_scene(file);
  const std::vector<Triangle> once = scene.triangles;
  const std::vector<Vertex> vertices = scene.vertices;
  while (scene.triangles.size() < 400) {  // several clusters, one below the other
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    for (Vertex vertex : vertices) {
      vertex.position[1] -= 0.5f * static_cast<float>(scene.triangles.size() / once.size());
      scene.vertices.push_back(vertex);
    }
    for (Triangle triangle : once) {
      for (std::uint32_t& corner : triangle.vertex) corner += first;
      scene.triangles.push_back(triangle);
    }
  }
  Session session(choose_device());
  const SceneBuffers buffers = upload_scene(session, scene);
  Rasterizer rasterizer(session, buffers, Rasterizer::kMaxListed, 1);
  Buffer depth = session.buffer(kSize * kSize * sizeof(float), "depth");
  for (const SceneLight& light : scene.lights) {
    for (const ClpvView& view : shadow_views(light.data, buffers.bounds, kSize))
      rasterizer.rasterize_shadow(view, depth);
  }
  session.queue().finish();
}

/// Renders a frame with a medium; then gather.cl and radiance.cl at points, whose number fills no
/// row, and light() on a G-buffer of positions and of depths, some of them no surface.
void points(const char* file) {
  Options options;
  for (const auto& [name, value] : std::map<std::string, std::string>{{"width", "12"},
                                                                      {"height", "5"},
                                                                      {"grid", "3"},
                                                                      {"cascades", "2"},
                                                                      {"cascade-size", "5"},
                                                                      {"rsm-size", "8"},
                                                                      {"shadow-size", "8"},
                                                                      {"bounces", "2"},
                                                                      {"coarser-directions", "24"}})
    options.set(name, value);
  Scene scene(file);
  scene.set_medium(
      Medium{.scattering = {0.1, 0.1, 0.1}, .absorption = {0.05, 0.05, 0.05}, .anisotropy = 0.3});
  Renderer renderer(scene, options);
  renderer.render();
  const Vec3 eye{0, 0.8, 2};  // the camera's: all calls have the same light
  std::vector<std::array<float, 3>> points, directions;
  for (int i = 0; i < 11; ++i) {
    points.push_back({0.3f * i - 1, 0.2f, 0.1f * i});
    directions.push_back({1, 0.1f * i, -0.5f});
  }
  renderer.irradiance(points, directions);
  renderer.radiance(points, directions);

  points.resize(12 * 5, {0.1f, 0.2f, 0.3f}), directions.resize(12 * 5, {0, 2, 0});
  directions[3] = {0, 0, 0}, points[4][0] = NAN;
  std::vector<float> depths(12 * 5, 1.5f);
  depths[5] = -INFINITY;
  renderer.light({.width = 12, .height = 5, .normals = directions, .positions = points}, eye);
  renderer.light({.width = 12, .height = 5, .normals = directions, .depths = depths}, "");
}

}  // namespace
}  // namespace clpv

int main(int count, char** arguments) {
  const std::string_view name = count > 1 ? arguments[1] : "";
  if (name == "hidden_clusters" && count == 3) return clpv::hidden_clusters(arguments[2]), 0;
  if (name == "points" && count == 3) return clpv::points(arguments[2]), 0;
  std::fprintf(stderr, "usage: %s hidden_clusters SCENE | points SCENE\n", arguments[0]);
  return 2;
}
