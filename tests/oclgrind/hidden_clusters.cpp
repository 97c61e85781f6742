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
  while (scene.triangles.size() < 200)  // several clusters
    scene.triangles.insert(scene.triangles.end(), once.begin(), once.end());
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
