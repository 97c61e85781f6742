// SPDX-License-Identifier: MIT
// Draws shadow maps in two parts, as those of scenes of many more triangles: hidden_clusters SCENE.
#include "pipeline/raster/rasterize.hpp"
#include "pipeline/raster/view.hpp"
#include "scene/load.hpp"

int main(int, char** arguments) {
  using namespace clpv;
  constexpr int kSize = 16;
  SceneData scene = load_scene(arguments[1]);
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
