// SPDX-License-Identifier: MIT
// Renders the indirect light of a scene and prints its mean: render_cornell scenes/cornell.json
// [IMAGE.exr|.png]
#include <clpv/renderer.hpp>
#include <iostream>

int main(int argc, char** argv) try {
  const clpv::Scene scene(argc > 1 ? argv[1] : "scenes/cornell.json");
  clpv::Renderer renderer(
      scene, clpv::Options().set("basis", "sh2").set("width", "160").set("height", "90"));
  const clpv::Image image = renderer.render(clpv::View::indirect);
  if (argc > 2) clpv::save_image(argv[2], image);

  double green = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) green += image.at(x, y, 1);
  std::cout << "mean indirect green radiance: " << green / static_cast<double>(image.pixel_count())
            << '\n';
  return green > 0 ? 0 : 1;
} catch (const clpv::Error& error) {
  std::cerr << error.what() << '\n';
  return static_cast<int>(error.code());
}
