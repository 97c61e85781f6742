// SPDX-License-Identifier: MIT
// An image in memory: named float channels, layers by name, and what a file says about itself.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

/// What the numbers mean: proportional to light, or sRGB-encoded for a display (0 to 1).
enum class Encoding { linear, srgb };

/// Row 0 is the top row; channels interleaved: pixels[(y * width + x) * channels.size() + c].
/// Layers as OpenEXR has them: channel "indirect.R" is R of layer "indirect"; one without a dot belongs to
/// the layer named "". Alpha ("A") is 1 where there is a surface and 0 in the background.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<float> pixels;
  std::map<std::string, std::string> metadata;  ///< every option that made the image, by its name
  Encoding encoding = Encoding::linear;

  std::size_t pixel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  float& at(int x, int y, std::size_t channel) {
    return pixels[(static_cast<std::size_t>(y) * width + x) * channels.size() + channel];
  }
  float at(int x, int y, std::size_t channel) const { return const_cast<Image*>(this)->at(x, y, channel); }
  std::optional<std::size_t> channel(std::string_view name) const;  ///< its index
};

/// Writes a linear image of channels R, G, B and perhaps A: .exr as it is (32-bit float, metadata kept); .png times
/// 2^exposure [EV], through the ACES tone curve, sRGB-encoded. The file appears whole or not at all. Throws Error(usage) for
/// another extension, Error(run_time) where it cannot be written.
void save_image(const std::filesystem::path& path, const Image& image, float exposure = 0);

}  // namespace clpv
