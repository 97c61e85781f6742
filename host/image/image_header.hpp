// SPDX-License-Identifier: MIT
// The size an encoded image claims, read without decoding it; and what of a PNG a decoder is given.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace clpv {

enum class ImageFormat { png, jpeg };

struct ImageHeader {
  ImageFormat format;
  std::uint32_t width, height;
  bool complete;  ///< its end is there; and, of a PNG, all chunks before it are as long as they say
};

/// Nothing where the bytes are neither PNG nor JPEG, or their header is cut off.
std::optional<ImageHeader> read_image_header(std::span<const std::uint8_t> bytes);

/// Of a complete PNG, the chunks that its pixels need, and its plain texts. Others may be packed, and libpng makes room for
/// what they say they are when unpacked.
std::vector<std::uint8_t> bare_png(std::span<const std::uint8_t> bytes);

}  // namespace clpv
