// SPDX-License-Identifier: MIT
// Moves a camera through a scene, replaces its lights, and prints times and light: walk
// scenes/cornell.json [IMAGE.png]
#include <clpv/renderer.hpp>
#include <iostream>

int main(int argc, char** argv) try {
  clpv::Scene scene(argc > 1 ? argv[1] : "scenes/cornell.json");
  clpv::Renderer renderer(
      scene, clpv::Options().set("basis", "sh2").set("width", "160").set("height", "90"));

  // A moving camera keeps the volumes until a cascade moves by a cell.
  for (int step = 0; step < 4; ++step) {
    const double x = 0.25 + 0.02 * step;
    renderer.render(clpv::View::full,
                    clpv::Camera{.eye = {x, 0.27, 0.05}, .target = {x, 0.27, 0.3}});
    const clpv::Stats stats = renderer.stats();
    std::cout << "step " << step << ": " << clpv::ms_of(stats.times, "frame") << " ms, propagation "
              << clpv::ms_of(stats.times, "propagate") << " ms\n";
  }

  // A lamp in place of the scene's lights recomputes the light.
  scene.set_lights({{.kind = clpv::LightKind::point,
                     .position = {0.28, 0.45, 0.28},
                     .intensity = {0.5, 0.45, 0.4}}});
  const clpv::Image image = renderer.render(clpv::View::full, "front");
  if (argc > 2) clpv::save_image(argv[2], image, scene.exposure());
  const auto [red, green, blue] = renderer.irradiance({0.28, 0.27, 0.2}, {0, 1, 0});
  std::cout << "indirect light on an upward surface: " << red << ' ' << green << ' ' << blue
            << " W/m^2\n";
  for (const clpv::LightVolume& volume : renderer.volumes())
    std::cout << "cascade of " << volume.n << "^3 cells of " << volume.cell << " m, basis "
              << volume.basis << '\n';
  return red > 0 ? 0 : 1;
} catch (const clpv::Error& error) {
  std::cerr << error.what() << '\n';
  return static_cast<int>(error.code());
}
