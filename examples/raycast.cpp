// SPDX-License-Identifier: MIT
// Lights a G-buffer that this program casts itself, with a panoramic camera in a box: raycast
// scenes/cornell.json [IMAGE.exr]
#include <algorithm>
#include <clpv/renderer.hpp>
#include <cmath>
#include <iostream>

namespace {

using Vectors = std::vector<std::array<float, 3>>;

constexpr int kWidth = 128, kHeight = 64;

/// Where rays of all directions from the eye leave a box.
void cast(const clpv::Vec3& eye, const std::array<clpv::Vec3, 2>& box, Vectors& positions,
          Vectors& normals) {
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double polar = M_PI * (y + 0.5) / kHeight, azimuth = 2 * M_PI * (x + 0.5) / kWidth;
      const clpv::Vec3 ray{std::sin(polar) * std::cos(azimuth), std::cos(polar),
                           std::sin(polar) * std::sin(azimuth)};
      clpv::Vec3 distances;
      for (int i = 0; i < 3; ++i)
        distances[i] = ((ray[i] > 0 ? box[1][i] : box[0][i]) - eye[i]) / ray[i];
      const auto nearest = std::min_element(distances.begin(), distances.end());
      std::array<float, 3> position{}, normal{};
      for (int i = 0; i < 3; ++i) position[i] = static_cast<float>(eye[i] + *nearest * ray[i]);
      normal[nearest - distances.begin()] = ray[nearest - distances.begin()] > 0 ? -1.0f : 1.0f;
      positions.push_back(position);
      normals.push_back(normal);
    }
  }
}

}  // namespace

int main(int argc, char** argv) try {
  const clpv::Scene scene(argc > 1 ? argv[1] : "scenes/cornell.json");
  clpv::Renderer renderer(
      scene, clpv::Options().set("basis", "sh2").set("width", "128").set("height", "64"));
  const clpv::Vec3 eye{0.278, 0.273, 0.2};
  Vectors positions, normals;
  cast(eye, scene.bounds(), positions, normals);
  const Vectors light = renderer.light(
      {.width = kWidth, .height = kHeight, .normals = normals, .positions = positions}, eye);
  clpv::Image image{.width = kWidth,
                    .height = kHeight,
                    .channels = {"R", "G", "B"},
                    .pixels = {},
                    .metadata = {}};
  for (const auto& pixel : light)
    image.pixels.insert(image.pixels.end(), pixel.begin(), pixel.end());
  if (argc > 2) clpv::save_image(argv[2], image, scene.exposure());
  const float most = *std::max_element(image.pixels.begin(), image.pixels.end());
  std::cout << "brightest irradiance: " << most << " W/m^2\n";
  return most > 0 ? 0 : 1;
} catch (const clpv::Error& error) {
  std::cerr << error.what() << '\n';
  return static_cast<int>(error.code());
}
