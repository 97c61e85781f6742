// SPDX-License-Identifier: MIT
// Equirectangular sky maps: directions, texels and reading from files.
#include "scene/sky.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "image/image_io.hpp"
#include "scene/bounds.hpp"
#include "support/error.hpp"
#include "support/fingerprint.hpp"

namespace clpv {
namespace {

using std::numbers::pi;

constexpr int kGroundRows = 512;  // rows of a sky with ground, for a sharp horizon

struct MapPoint {
  double x, y;  ///< from the left and top edges [texels]
};

MapPoint point_of(const Sky& sky, const glm::dvec3& direction) {
  const double turn = std::atan2(direction.x, -direction.z) - sky.rotation;  // from -z towards +x
  const double across = turn / (2 * pi) + 0.5,
               down = std::acos(std::clamp(direction.y, -1.0, 1.0)) / pi;
  return {(across - std::floor(across)) * sky.width, down * sky.height};
}

std::size_t index_of(const Sky& sky, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(sky.width) +
         static_cast<std::size_t>(x);
}

}  // namespace

std::size_t Sky::texel_at(const glm::dvec3& direction) const {
  const MapPoint point = point_of(*this, direction);
  return index_of(*this, std::clamp(static_cast<int>(point.x), 0, width - 1),
                  std::clamp(static_cast<int>(point.y), 0, height - 1));
}

glm::vec3 Sky::interpolated(const glm::dvec3& direction) const {
  const MapPoint point = point_of(*this, direction);
  const double left = std::floor(point.x - 0.5), top = std::floor(point.y - 0.5);
  const auto across = static_cast<float>(point.x - 0.5 - left),
             down = static_cast<float>(point.y - 0.5 - top);
  const auto at = [&](double x, double y) {
    return texels[index_of(*this, (static_cast<int>(x) + width) % width,
                           std::clamp(static_cast<int>(y), 0, height - 1))];
  };
  return glm::mix(glm::mix(at(left, top), at(left + 1, top), across),
                  glm::mix(at(left, top + 1), at(left + 1, top + 1), across), down);
}

glm::dvec3 Sky::direction(double x, double y) const {
  const double turn = 2 * pi * (x / width - 0.5) + rotation, down = pi * y / height,
               out = std::sin(down);
  return {out * std::sin(turn), std::cos(down), -out * std::cos(turn)};
}

double Sky::solid_angle(int row) const {
  return 2 * pi / width * (std::cos(pi * row / height) - std::cos(pi * (row + 1) / height));
}

float Sky::max_radiance() const {
  float largest = 0;
  for (const glm::vec3& texel : texels) largest = std::max({largest, texel.x, texel.y, texel.z});
  return largest;
}

Sky constant_sky(const glm::vec3& radiance) {
  Sky sky;
  sky.texels = {radiance};
  return sky;
}

Sky sky_with_ground(const glm::vec3& above, const glm::vec3& below) {
  Sky sky;
  sky.height = kGroundRows;
  sky.texels.assign(kGroundRows, above);
  std::fill(sky.texels.begin() + kGroundRows / 2, sky.texels.end(), below);
  return sky;
}

Sky read_sky(const std::filesystem::path& path, double scale, double rotation) {
  ImageLimits limits;
  limits.side = std::max(bounds::kSkyWidth, bounds::kSkyHeight);
  limits.file_bytes = bounds::kImageFileBytes;
  limits.channels = bounds::kSkyChannels;
  const Image image = extract_layer(read_image(path, limits), "", path.string());
  if (image.encoding != Encoding::linear)
    throw Error(ExitCode::bad_input, "{}: sRGB-encoded sky; allowed: linear EXR and HDR files",
                path.string());
  if (image.width > bounds::kSkyWidth || image.height > bounds::kSkyHeight) {
    throw Error(ExitCode::bad_input, "{}: sky of {} x {} pixels; allowed: up to {} x {}",
                path.string(), image.width, image.height, bounds::kSkyWidth, bounds::kSkyHeight);
  }
  const std::array<const char*, 3> names = {"R", "G", "B"};
  Sky sky;
  sky.width = image.width, sky.height = image.height, sky.rotation = rotation;
  sky.texels.resize(image.pixel_count());
  for (const std::string& note : image.notes)
    sky.notes.push_back(fmt::format("{}: {}", path.filename().string(), note));
  if (const auto window = image.windows.find(""); window != image.windows.end()) {
    const PixelWindow& has = window->second;
    sky.notes.push_back(
        fmt::format("{}: has only pixels ({}, {}) to ({}, {}) of {} x {}; the others are 0",
                    path.filename().string(), has.left, has.top, has.right - 1, has.bottom - 1,
                    image.width, image.height));
  }
  for (int channel = 0; channel < 3; ++channel) {
    const char* name = names[channel];
    const auto from = image.channel(name);
    if (!from)
      throw Error(ExitCode::bad_input, "{}: found no channel {}; allowed: R, G and B",
                  path.string(), name);
    for (std::size_t i = 0; i < sky.texels.size(); ++i) {
      const float value = image.pixels[i * image.channels.size() + *from];
      const double scaled = scale * double{value};
      if (!(scaled >= 0 && scaled <= bounds::kSkyRadiance)) {
        throw Error(
            ExitCode::bad_input, "{}: pixel {},{} channel {}: found {}, times {}; allowed: 0 to {}",
            path.string(), i % static_cast<std::size_t>(sky.width),
            i / static_cast<std::size_t>(sky.width), name, value, scale, bounds::kSkyRadiance);
      }
      sky.texels[i][channel] = static_cast<float>(scaled);
    }
  }
  return sky;
}

void add_sky(Fingerprint& print, const Sky& sky) {
  print.add(sky.width).add(sky.height).add(sky.rotation).add(sky.texels);
}

}  // namespace clpv
