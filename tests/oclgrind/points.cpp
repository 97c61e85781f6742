// SPDX-License-Identifier: MIT
// Renders a frame with a medium; then gather.cl and radiance.cl at points, whose number fills no
// row, and light() on a G-buffer of positions and of depths, some of them no surface: points SCENE.
#include <cmath>

#include "clpv/renderer.hpp"

int main(int, char** arguments) {
  clpv::Options options;
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
  clpv::Scene scene(arguments[1]);
  scene.set_medium(clpv::Medium{
      .scattering = {0.1, 0.1, 0.1}, .absorption = {0.05, 0.05, 0.05}, .anisotropy = 0.3});
  clpv::Renderer renderer(scene, options);
  renderer.render();
  const clpv::Vec3 eye{0, 0.8, 2};  // the camera's: all calls have the same light
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
