// SPDX-License-Identifier: MIT
// Runs gather.cl and radiance.cl at points: points SCENE. Their number fills no row.
#include "clpv/renderer.hpp"

int main(int, char** arguments) {
  clpv::Options options;
  for (const auto& [name, value] : std::map<std::string, std::string>{{"width", "12"},
                                                                      {"height", "9"},
                                                                      {"grid", "3"},
                                                                      {"cascades", "2"},
                                                                      {"cascade-size", "5"},
                                                                      {"rsm-size", "8"},
                                                                      {"shadow-size", "8"},
                                                                      {"directions", "24"},
                                                                      {"coarser-directions", "24"}})
    options.set(name, value);
  clpv::Renderer renderer(clpv::Scene(arguments[1]), options);
  renderer.render();
  std::vector<std::array<float, 3>> points, directions;
  for (int i = 0; i < 11; ++i) {
    points.push_back({0.3f * i - 1, 0.2f, 0.1f * i});
    directions.push_back({1, 0.1f * i, -0.5f});
  }
  renderer.irradiance(points, directions);
  renderer.radiance(points, directions);
}
