// SPDX-License-Identifier: MIT
// Image in memory: named float channels, layers, and metadata.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace clpv {

/// Meaning of the values: linear in light, or sRGB-encoded for a display (0 to 1).
enum class Encoding { linear, srgb };

/// Rectangle of pixels, columns left to right - 1, rows top to bottom - 1.
struct PixelWindow {
  int left = 0, top = 0, right = 0, bottom = 0;
  bool operator==(const PixelWindow&) const = default;
};

/// Image of `width` x `height` pixels. Row 0 is the top row. Channels are interleaved: pixels[(y *
/// width + x) * channels.size() + c]. Layers follow OpenEXR: channel "indirect.R" is R of layer
/// "indirect"; a channel without a dot belongs to layer "". Alpha ("A") is 1 on surfaces and 0 in
/// the background.
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;
  std::vector<float> pixels;
  /// Options that the image was rendered with, by name.
  std::map<std::string, std::string> metadata;
  Encoding encoding = Encoding::linear;
  /// For layers that the file holds only in part: the rectangle that it holds. Other pixels are 0.
  std::map<std::string, PixelWindow> windows;
  /// Names of the parts of an EXR file that has several. Their channels are layers of these names.
  std::vector<std::string> parts;
  /// Properties that reading converted or ignored, such as "chromaticities ...: converted to Rec.
  /// 709".
  std::vector<std::string> notes;

  std::size_t pixel_count() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
  float& at(int x, int y, std::size_t channel) {
    const auto row = static_cast<std::size_t>(y), column = static_cast<std::size_t>(x);
    return pixels[(row * static_cast<std::size_t>(width) + column) * channels.size() + channel];
  }
  float at(int x, int y, std::size_t channel) const {
    return const_cast<Image*>(this)->at(x, y, channel);
  }
  /// Index of a channel; empty if absent.
  std::optional<std::size_t> channel(std::string_view name) const;
};

/// Writes a linear image with channels R, G, B and optionally A. .exr: 32-bit floats, with
/// metadata. .png: values times 2^exposure [EV] (by default automatic_exposure()), through the tone
/// curve photographic, sRGB-encoded, on a black background. The file is complete or absent. Throws
/// Error: usage (another extension, an exposure that is not finite), bad_input (other values or
/// channels, fields that disagree), run_time (the file cannot be written).
void save_image(const std::filesystem::path& path, const Image& image,
                std::optional<float> exposure = {});

/// Exposure [EV] that brings the logarithmic mean of the luminance of the lit pixels (alpha and
/// luminance above 0) of a linear image to 0.14; 0 for an image without such pixels, and for the
/// views albedo, normal and depth.
float automatic_exposure(const Image& image);

}  // namespace clpv
