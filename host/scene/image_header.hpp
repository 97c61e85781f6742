// SPDX-License-Identifier: MIT
// The size an encoded image claims, read without decoding it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace clpv {

enum class ImageFormat { png, jpeg };

struct ImageHeader {
  ImageFormat format;
  std::uint32_t width, height;
  bool complete;  ///< its end marker is there
};

/// Nothing where the bytes are neither PNG nor JPEG, or their header is cut off.
std::optional<ImageHeader> read_image_header(std::span<const std::uint8_t> bytes);

}  // namespace clpv
